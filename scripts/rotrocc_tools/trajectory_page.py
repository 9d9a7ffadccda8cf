"""The page of a trajectory, from the tables that evaluate_trajectory has written: summary.csv and poses.csv;
by_length.csv and by_speed.csv if there is truth; and pairs.csv, which offline_odometry --stats wrote, if there is one.
"""
import json
import os
import pathlib
import re

import numpy

from rotrocc_tools import report_figures as figures
from rotrocc_tools import report_page as page
from rotrocc_tools import trajectory_plot
from rotrocc_tools.plot_style import DEGRADED, ESTIMATE, LOST, TEXT, TRUTH
from rotrocc_tools.tables import positions, read_columns

LEAFLET = pathlib.Path('/usr/share/javascript/leaflet')
MAP_SCRIPT = pathlib.Path(os.path.realpath(__file__)).with_name('trajectory_map.js')
COLORS = {'truth': TRUTH, 'estimate': ESTIMATE, 'degraded': DEGRADED, 'lost': LOST, 'text': TEXT}


def has_leaflet():
    """Whether Leaflet is installed; pages then have the map, and otherwise a picture."""
    return (LEAFLET / 'leaflet.min.js').is_file() and (LEAFLET / 'leaflet.css').is_file()


def rounded(values, digits):
    return [round(float(value), digits) for value in values]


def map_data(poses, states):
    """What the map shows: positions from above, and what it says of each pose. x is to the right, z forward."""
    time_s = 1e-9 * (poses['stamp_ns'] - poses['stamp_ns'][0])
    data = {'colors': COLORS, 'state': list(states), 'time_s': rounded(time_s, 3),
            'path_m': rounded(poses['path_m'], 1), 'height_m': rounded(-poses['y_m'], 2),
            'estimate': [rounded(poses[axis], 2) for axis in ('z_m', 'x_m')]}
    if 'true_x_m' in poses:
        data['truth'] = [rounded(poses['true_' + axis], 2) for axis in ('z_m', 'x_m')]
        data['error_m'] = rounded(numpy.linalg.norm(
            [poses[axis] - poses['true_' + axis] for axis in ('x_m', 'y_m', 'z_m')], axis=0), 3)
        data['step_error_m'] = rounded(numpy.nan_to_num(poses['step_translation_error_m']), 4)
    return data


def text_of(path):
    """Without the files that it names, as a page has none beside it."""
    text = path.read_text(encoding='utf-8')
    return re.sub(r'url\([^)]*\)', 'none', re.sub(r'//# sourceMappingURL=.*', '', text))


def map_of(poses, states):
    """The trajectory to zoom, to pan, and to ask each pair. It is by Leaflet, which Debian ships; the page contains it,
    so it opens offline."""
    style = text_of(LEAFLET / 'leaflet.css')
    scripts = [text_of(LEAFLET / 'leaflet.min.js'),
               'const data = %s;' % json.dumps(map_data(poses, states), separators=(',', ':')),
               text_of(MAP_SCRIPT)]
    return ('<style>\n%s\n#map { background: #fff; border: 1px solid #e2e5e8; border-radius: 6px; }\n'
            '#map .leaflet-container, #map { font: inherit; font-size: 14px; }\n</style>\n<div id="map"></div>\n'
            '%s' % (style, ''.join('<script>\n%s\n</script>\n' % script for script in scripts)))


def states_of(poses, pairs):
    """The state of the odometry at each pose; '' if unknown."""
    if pairs is None:
        return numpy.full(len(poses['stamp_ns']), '')
    known = dict(zip(pairs['stamp_ns'], pairs['state']))
    return numpy.array([known[stamp_ns] for stamp_ns in poses['stamp_ns']])


class TrajectoryPage:
    def __init__(self, folder, title):
        self.folder = folder
        self.title = title
        self.summary = {name: column[0] for name, column in read_columns(folder / 'summary.csv').items()}
        self.poses = read_columns(folder / 'poses.csv')
        self.has_truth = 'true_x_m' in self.poses
        pairs = folder / 'pairs.csv'
        self.pairs = read_columns(pairs) if pairs.is_file() else None
        self.states = states_of(self.poses, self.pairs)

    def picture(self, name, description, draw, *arguments):
        """Draws NAME.png, and returns its HTML."""
        path = self.folder / (name + '.png')
        draw(*arguments, path)
        return page.picture(path, description)

    def tiles(self):
        summary, entries = self.summary, []
        if summary.get('segments'):
            entries += [('%.3f' % summary['translation_percent'], '%', 'translation error'),
                        ('%.5f' % summary['rotation_deg_per_m'], 'deg/m', 'rotation error')]
        if self.has_truth:
            entries.append(('%.2f' % summary['drift_m'], 'm', 'final drift'))
        entries.append(('%.0f' % summary['path_m'], 'm', '%d poses, %.1f s' % (
            summary['poses'], summary['duration_s'])))
        if self.pairs:
            lost, degraded = [numpy.count_nonzero(self.pairs['state'] == state) for state in ('lost', 'degraded')]
            entries += [('%d' % lost, 'lost', '%d degraded' % degraded),
                        ('%.1f' % self.pairs['wall_ms'].mean(), 'ms', 'wall time per pair')]
        return page.tiles(entries)

    def trajectory(self):
        truth = positions(self.poses, 'true_') if self.has_truth else None
        marks = {state: self.states == state for state in ('degraded', 'lost')}
        path = self.folder / 'trajectory.png'
        trajectory_plot.draw(positions(self.poses), truth, path, marks)
        picture = page.picture(path, 'trajectory from above')
        note = 'Top view, and height along the path, in the frame of the first pose of the left camera.'
        if not has_leaflet():
            return page.section('Trajectory', note, picture)
        return page.section(
            'Trajectory', 'From above, in the frame of the first pose of the left camera. Drag to move, turn the '
            'wheel to zoom, point at the estimate to see its time, state and errors.',
            map_of(self.poses, self.states), page.details('As a picture, with the height', picture))

    def errors(self):
        by_length = read_columns(self.folder / 'by_length.csv')
        by_speed = read_columns(self.folder / 'by_speed.csv')
        if not len(by_length['length_m']):
            return page.section('Errors of segments', 'The path of %.1f m is too short for a segment.'
                                % self.summary['path_m'])
        tables = []
        for name, data, unit, scale in (('length_m', by_length, 'length<br>[m]', 1.0),
                                        ('speed_mps', by_speed, 'speed<br>[km/h]', 3.6)):
            rows = zip(scale * data[name], data['segments'], data['translation_percent'], data['rotation_deg_per_m'])
            tables.append(page.table([unit, 'segments', 'translation<br>[%]', 'rotation<br>[deg/m]'],
                                     [('%.4g %d %.3f %.5f' % row).split() for row in rows]))
        return page.section(
            'Errors by length and by speed', 'The metric of the KITTI odometry devkit, over %d segments '
            'of the path. Each segment counts for the two speeds next to its own.'
            % self.summary['segments'],
            self.picture('errors', 'translation and rotation error by length and by speed',
                         figures.plot_errors, by_length, by_speed), page.columns(*tables))

    def steps(self):
        parts = [self.picture('steps', 'errors from pose to pose and speed over time',
                              figures.plot_steps, self.poses, self.states)]
        if self.has_truth:
            rows = [[label] + ['%.4g' % (1e3 * self.summary[name % kind]) for kind in ('mean', 'rms', 'p95', 'max')]
                    for label, name in (('translation [mm]', 'step_translation_%s_m'),
                                        ('rotation [mdeg]', 'step_rotation_%s_deg'))]
            parts.append(page.table(['', 'mean', 'rms', '95th percentile', 'largest'], rows))
        title = 'Errors from pose to pose' if self.has_truth else 'Speed'
        return page.section(title, 'Pairs with an uncertain (degraded) or unknown (lost) motion are shaded.'
                            if self.pairs else 'By the stamps of the poses.', *parts)

    def stages(self):
        time_s = 1e-9 * (self.pairs['stamp_ns'] - self.poses['stamp_ns'][0])
        rows = [[label] + ['%.2f' % value for value in (times.mean(), *numpy.percentile(times, [50, 95, 100]))]
                for times, label in [(self.pairs[name], label) for name, label in [
                    *[(name, label) for name, _, label in figures.TIMES],
                    ('wall_ms', 'whole pair'), ('cpu_ms', 'CPU time, all threads')]]]
        return [
            page.section('Features per stage', 'Corners and depths are those of the keyframe.',
                         self.picture('counts', 'features left by each stage over time', figures.plot_counts, self.pairs,
                                      time_s)),
            page.section('Time per stage', 'Wall time, without image reading.',
                         self.picture('times', 'time of each stage over time', figures.plot_times, self.pairs, time_s),
                         page.table(['[ms]', 'mean', 'median', '95th percentile', 'largest'], rows)),
            page.section('Disparity bias', 'Correction to be added to all disparities, estimated online: at the end '
                         '%+.3f px, with a standard deviation of %.3f px. The significant part is applied.'
                         % (self.pairs['bias_estimated_px'][-1], self.pairs['bias_sigma_px'][-1]),
                         self.picture('bias', 'estimated disparity bias over time',
                                      figures.plot_bias, self.pairs, time_s))]

    def write(self):
        parts = [self.tiles(), self.trajectory()]
        if self.has_truth:
            parts.append(self.errors())
        parts.append(self.steps())
        if self.pairs:
            parts += self.stages()
        tables = sorted(path.name for path in self.folder.glob('*.csv'))
        parts.append(page.section('Tables', 'Files next to this page: %s.' % page.links(tables)))
        page.write_page(self.folder / 'index.html', self.title, 'Stereo visual odometry' + (
            ' compared with ground truth' if self.has_truth else ', without ground truth'), *parts)
