"""The report of kitti_benchmark: summary of all sequences, and a row for each."""
import shutil

import numpy

from rotrocc_tools import report_figures as figures
from rotrocc_tools import report_page as page
from rotrocc_tools.tables import read_columns, read_table, write_table

DEVKIT_M = 100.0  # shortest segment of the devkit; short sequences use shorter ones
GROUPS = [('devkit', 'Sequences by the KITTI metric', 'Segments of 100 to 800 m, as on the KITTI leaderboard.'),
          ('short', 'Short sequences', 'Segments of 5 to 40 m: too short for longer ones.'),
          ('none', 'Sequences without errors', 'No ground truth, or too short for any segment.')]
COLUMNS = ['sequence', 'group', 'pairs', 'path_m', 'segments', 'translation_percent',
           'rotation_deg_per_m', 'lost', 'degraded', 'wall_ms', 'cpu_ms', 'bias_px', 'bias_sigma_px',
           'duration_s']
BINS = {'length': 'length_m', 'speed': 'speed_mps'}
ERRORS = ['translation_percent', 'rotation_deg_per_m']


class Result:
    """A finished sequence. Errors are nan without ground truth."""

    def __init__(self, folder):
        self.folder = folder
        summary = {name: column[0] for name, column in read_columns(folder / 'summary.csv').items()}
        pairs = read_columns(folder / 'pairs.csv')
        self.segments = int(summary.get('segments', 0))
        self.bins, self.group = {}, 'none'
        if self.segments:
            self.bins = {name: read_columns(folder / ('by_%s.csv' % name)) for name in BINS}
            self.group = 'devkit' if self.bins['length']['length_m'][-1] >= DEVKIT_M else 'short'
        self.row = {
            'sequence': folder.name, 'group': self.group, 'pairs': len(pairs['stamp_ns']),
            'path_m': summary['path_m'], 'segments': self.segments,
            'lost': numpy.count_nonzero(pairs['state'] == 'lost'),
            'degraded': numpy.count_nonzero(pairs['state'] == 'degraded'),
            'wall_ms': pairs['wall_ms'].mean(), 'cpu_ms': pairs['cpu_ms'].mean(),
            'bias_px': pairs['bias_estimated_px'][-1], 'bias_sigma_px': pairs['bias_sigma_px'][-1],
            'duration_s': read_columns(folder / 'duration.csv')['seconds'][0]}
        for name in ERRORS:
            self.row[name] = summary[name] if self.segments else float('nan')


def pool(tables, bin_name):
    """Mean over the segments of all sequences, from their means and counts."""
    together = {name: numpy.concatenate([table[name] for table in tables]) for name in (bin_name, 'segments', *ERRORS)}
    keys, places = numpy.unique(together[bin_name], return_inverse=True)
    counts = numpy.bincount(places, together['segments']).astype(int)
    return {bin_name: keys, 'segments': counts, **{
        name: numpy.bincount(places, together['segments'] * together[name]) / counts for name in ERRORS}}


def total_of(rows, name):
    return sum(row[name] for row in rows)


def mean_error(rows, name):
    """Mean over the segments of all sequences, as on the KITTI leaderboard."""
    return numpy.average([row[name] for row in rows], weights=[row['segments'] for row in rows])


def mean_cpu_ms(rows):
    return numpy.average([row['cpu_ms'] for row in rows], weights=[row['pairs'] for row in rows])


def read_earlier(folder):
    """Tables of an earlier report: {'sequences': {name: row}, 'length': ..., 'speed': ...}."""
    path = folder / 'sequences.csv'
    if not path.is_file():
        raise RuntimeError('%s is not a result folder: it has no sequences.csv' % folder)
    rows = {row['sequence']: row for row in read_table(path)}
    for row in rows.values():
        for name in ERRORS + ['segments']:
            row[name] = float(row[name])
    return {'sequences': rows, **{name: read_columns(folder / ('by_%s.csv' % name)) for name in BINS}}


def of_group(table, group):
    inside = table['group'] == group
    return {name: column[inside] for name, column in table.items()}


def write_tables(output, results):
    def cell(value):
        return '%.10g' % value if isinstance(value, float) else value
    write_table(output / 'sequences.csv', COLUMNS,
               [[cell(result.row[name]) for name in COLUMNS] for result in results])
    for name, bin_name in BINS.items():
        rows = []
        for group in sorted({result.group for result in results if result.bins}):
            pooled = pool([result.bins[name] for result in results if result.group == group], bin_name)
            rows += [[group, '%g' % key, '%d' % count, *['%.10g' % error for error in errors]]
                     for key, count, *errors in zip(*pooled.values())]
        write_table(output / ('by_%s.csv' % name), ['group', bin_name, 'segments'] + ERRORS, rows)


def change(now, before):
    """Relative change, with sign and color."""
    if not before > 0.0:
        return '–'
    percent = 100.0 * (now / before - 1.0)
    if abs(percent) < 0.05:
        return 'same'
    return '<span class="%s">%+.1f %%</span>' % ('worse' if percent > 0 else 'better', percent)


def results_table(rows, names_of_errors=(), cells_of_errors=lambda row: [], total=None):
    header = ['sequence', 'pairs', 'path<br>[m]', *names_of_errors, 'lost', 'degr.', 'CPU<br>[ms]', 'bias [px]']
    return page.table(header, [[
        page.link('sequences/%s/index.html' % row['sequence'], row['sequence']), '%d' % row['pairs'],
        '%.0f' % row['path_m'], *cells_of_errors(row), '%d' % row['lost'], '%d' % row['degraded'],
        '%.1f' % row['cpu_ms'], '%+.2f ± %.2f' % (row['bias_px'], row['bias_sigma_px'])] for row in rows], total)


class GroupSection:
    """Table and pictures of the sequences with the same metric."""

    def __init__(self, output, group, results, earlier):
        self.output, self.group = output, group
        self.rows = [result.row for result in results]
        self.tables = [pool([result.bins[name] for result in results], bin_name)
                       for name, bin_name in BINS.items()]
        self.before = {}
        self.tables_before = None
        if earlier:
            names = [row['sequence'] for row in self.rows]
            self.before = {name: row for name, row in earlier['sequences'].items()
                           if row['group'] == group and name in names}
            self.tables_before = [of_group(earlier[name], group) for name in BINS]

    def error_cells(self, row, before):
        cells = []
        for name, form in zip(ERRORS, ('%.3f', '%.5f')):
            cells.append(form % row[name])
            if self.before:
                cells += [form % before[name], change(row[name], before[name])] if before else ['–', '–']
        return cells

    def total(self):
        common = [row for row in self.rows if row['sequence'] in self.before]
        now = {name: mean_error(common or self.rows, name) for name in ERRORS}
        before = {name: mean_error(self.before.values(), name) for name in ERRORS} if common else None
        return ['mean', '%d' % total_of(self.rows, 'pairs'), '%.0f' % total_of(self.rows, 'path_m'),
                *self.error_cells(now, before), '%d' % total_of(self.rows, 'lost'),
                '%d' % total_of(self.rows, 'degraded'), '%.1f' % mean_cpu_ms(self.rows), '']

    def write(self, title, note):
        further = ['earlier', 'change'] if self.before else []
        table = results_table(self.rows, ['translation<br>[%]', *further, 'rotation<br>[deg/m]', *further],
                              lambda row: self.error_cells(row, self.before.get(row['sequence'])), self.total())
        note += ' The mean is over all %d segments%s.' % (
            total_of(self.rows, 'segments'), ' of the sequences in both reports' if self.before else '')

        curves = self.output / ('errors_%s.png' % self.group)
        figures.plot_errors(*self.tables, curves, self.tables_before)
        return page.section(title, note, table, page.picture(curves, 'errors by length and by speed'))


def print_table(results):
    print('%-20s %6s %8s %15s %16s %5s %8s' % ('sequence', 'pairs', 'path [m]', 'translation [%]',
                                             'rotation [deg/m]', 'lost', 'CPU [ms]'))
    for group, _, _ in GROUPS:
        rows = [result.row for result in results if result.group == group]
        for row in rows:
            print('%-20s %6d %8.0f %15.3f %16.5f %5d %8.1f' % tuple(row[name] for name in (
                'sequence', 'pairs', 'path_m', *ERRORS, 'lost', 'cpu_ms')))
        if rows and group != 'none':
            print('%-20s %6d %8.0f %15.3f %16.5f' % (
                'mean of segments', total_of(rows, 'pairs'), total_of(rows, 'path_m'),
                *(mean_error(rows, name) for name in ERRORS)))


def write(output, names, failed, earlier, title):
    """Writes the report of finished sequences; `failed` is {name: reason}, `earlier` is from read_earlier()."""
    results = [Result(output / 'sequences' / name) for name in names]
    write_tables(output, results)
    (output / 'trajectories').mkdir(exist_ok=True)
    for result in results:
        shutil.copyfile(str(result.folder / 'estimate.txt'),
                        str(output / 'trajectories' / (result.folder.name + '.txt')))

    parts = []
    if failed:
        parts.append(page.section('Failed', '', page.table(['sequence', 'reason'], [
            (page.text(name), page.text(why)) for name, why in failed.items()])))
    for group, heading, note in GROUPS:
        members = [result for result in results if result.group == group]
        if members and group == 'none':
            parts.append(page.section(heading, note, results_table([result.row for result in members])))
        elif members:
            parts.append(GroupSection(output, group, members, earlier).write(heading, note))
    parts.append(page.section('Tables', 'Files next to this page: %s; estimated poses in KITTI format in trajectories.'
                              % page.links(['sequences.csv', 'by_length.csv', 'by_speed.csv'])))
    page.write_page(output / 'index.html', title, 'Stereo visual odometry, %d sequences%s' % (
        len(results), ', compared with an earlier report' if earlier else ''), *parts)
    print_table(results)
    print('report: %s' % (output / 'index.html'))
