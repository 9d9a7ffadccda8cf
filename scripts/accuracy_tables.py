"""The tables of scripts/accuracy: each is a header and rows of text.

`runs` is {(folder of a drive, column): Run}.
"""
import collections

import numpy

from odometry_runs import CLIP_LENGTHS_M, LENGTHS_M, STEP, read_poses

LONG_CLIP_LENGTHS_M = [50, 60, 70, 80]  # for raw drives, whose ground truth is noisy over short distances
BOUND_99 = 16.81  # of chi squared with 6 degrees of freedom
AXES = ['x', 'y', 'z', 'rx', 'ry', 'rz']
REST_M = 1e-6  # shorter true steps count as standstill


def mean_of(segments, name):
    return float(numpy.mean([segment[name] for segment in segments]))


# Translation and rotation error.

def error_rows(clips, drives):
    """(label, drive, lengths, step) of each row."""
    rows = []
    for clip in clips:
        rows.append((clip.name, clip, CLIP_LENGTHS_M, 1))
        if clip.name.startswith('raw'):
            rows.append((clip.name + ', 50 to 80 m', clip, LONG_CLIP_LENGTHS_M, 1))
    return rows + [(drive.name, drive, LENGTHS_M, STEP) for drive in drives]


def comparison_row(label, texts, lost, columns):
    """Errors below the default's, as printed, are bold; lost pairs are given in brackets."""
    cells = [label]
    for column in columns:
        text = texts[column]
        if float(text) < float(texts['default']):
            text = '**%s**' % text
        cells.append(text + (' (%d lost)' % lost[column] if lost[column] else ''))
    return cells


def verdict_rows(all_texts, columns):
    """Number of rows in which the default is better, and worse, than each column."""
    rows = []
    for label, sign in (('*default is better in*', 1), ('*default is worse in*', -1)):
        counts = [sum(sign * (float(texts[column]) - float(texts['default'])) > 0
                      for texts in all_texts) for column in columns]
        rows.append([label] + ['' if column == 'default' else '%d of %d' % (count, len(all_texts))
                               for column, count in zip(columns, counts)])
    return rows


def make_error_tables(runs, clips, drives, columns):
    tables = collections.OrderedDict()
    labels = [('translation', 'translation_percent', '%.3f', 'translation error [%]'),
              ('rotation', 'rotation_deg_per_m', '%.5f', 'rotation error [deg/m]')]
    for name, *_, title in labels:
        tables[name] = ([title] + columns, [])
    texts = {name: [] for name in tables}
    for label, drive, lengths_m, step in error_rows(clips, drives):
        segments = {column: runs[drive, column].segments(lengths_m, step) for column in columns}
        lost = {column: runs[drive, column].lost for column in columns}
        for name, field, form, _ in labels:
            texts[name].append({column: form % mean_of(segments[column], field)
                                for column in columns})
            tables[name][1].append(comparison_row(label, texts[name][-1], lost, columns))
    for name, (_, rows) in tables.items():
        rows += verdict_rows(texts[name], columns)
    return tables


# The same drives with different noise.

def make_noise_table(runs, noisy, columns):
    seeds = list(collections.OrderedDict.fromkeys(seed for _, seed in noisy))
    rows = []
    for name in collections.OrderedDict.fromkeys(name for name, _ in noisy):
        errors = {column: numpy.array([
            mean_of(runs[noisy[name, seed], column].segments(LENGTHS_M, STEP),
                    'translation_percent') for seed in seeds]) for column in columns}
        errors['difference'] = errors[columns[0]] - errors[columns[1]]
        for label, values in errors.items():
            rows.append([name, label] + ['%.4f' % value for value in values] +
                        ['%.4f' % values.mean(), '%.4f' % values.std(ddof=1)])
    return (['translation error [%]', ''] + ['noise %d' % seed for seed in seeds] +
            ['mean', 'standard deviation'], rows)


# Miscalibrated rigs.

def errors_from(run, first_pose):
    segments = run.segments(LENGTHS_M, STEP)
    return [segment for segment in segments if segment['first_pose'] >= first_pose]


def make_rig_table(runs, drives, rigs, settled_after):
    header = ['drive', 'injected [px]', 'estimate after %d pairs [px]' % settled_after,
              'its sigma [px]', 'estimate + injected [px]', 'applied [px]',
              'translation error from there on [%]', 'relative to the perfect rig',
              'whole drive [%]', 'whole drive without calibration [%]']
    rows = []
    for drive in drives:
        offsets = [bias for name, bias in rigs if name == drive.name]
        perfect = None
        for bias in [0.0] * bool(offsets) + offsets:
            folder = rigs.get((drive.name, bias), drive)
            run = runs[folder, 'default']
            pair = run.pairs[settled_after]
            estimate = float(pair['bias_estimated_px'])
            settled = mean_of(errors_from(run, settled_after), 'translation_percent')
            perfect = perfect or settled
            whole = [mean_of(runs[folder, column].segments(LENGTHS_M, STEP), 'translation_percent')
                     for column in ('default', 'no calibration')]
            rows.append([drive.name, '%+.1f' % bias, '%+.3f' % estimate,
                         '%.3f' % float(pair['bias_sigma_px']), '%+.3f' % (estimate + bias),
                         '%+.3f' % float(pair['bias_applied_px']), '%.3f' % settled,
                         '%+.0f %%' % (100 * (settled / perfect - 1))] +
                        ['%.3f' % error for error in whole])
    return header, rows


# Standstill.

def rotation_angles(rotations):
    """Angles [rad] of n x 3 x 3 rotations, exact for small ones too."""
    sines = 0.5 * numpy.linalg.norm([rotations[:, 2, 1] - rotations[:, 1, 2],
                                     rotations[:, 0, 2] - rotations[:, 2, 0],
                                     rotations[:, 1, 0] - rotations[:, 0, 1]], axis=0)
    cosines = 0.5 * (numpy.trace(rotations, axis1=1, axis2=2) - 1.0)
    return numpy.arctan2(sines, cosines)


def longest_stop(poses):
    """First and last index of the longest standstill."""
    best = first = (0, 0)
    for i, step in enumerate(numpy.linalg.norm(numpy.diff(poses[:, :, 3], axis=0), axis=1)):
        first = (first[0], i + 1) if step < REST_M else (i + 1, i + 1)
        best = max(best, first, key=lambda stop: stop[1] - stop[0])
    return best


def farthest(poses):
    """Largest distance [mm] and angle [deg] from the first pose."""
    distances = numpy.linalg.norm(poses[:, :, 3] - poses[0, :, 3], axis=1)
    angles = rotation_angles(numpy.einsum('ji,njk->nik', poses[0, :, :3], poses[:, :, :3]))
    return 1e3 * distances.max(), numpy.degrees(angles.max())


def make_standstill_table(runs, standing, drives, columns):
    stops = [(drive, drive.name) for drive in standing]
    stops += [(drive, 'the stop of ' + drive.name) for drive in drives
              if drive.name in ('city', 'parking')]
    rows = []
    for drive, label in stops:
        first, last = longest_stop(read_poses(drive / 'poses.txt'))
        row = [label, '%d' % (last - first)]
        for column in columns:
            estimate = read_poses(runs[drive, column].trajectory)
            row.append('%.2f mm / %.4f deg' % farthest(estimate[first:last + 1]))
        rows.append(row)
    return ['', 'pairs'] + columns, rows


# Consistency.

def rotation_of(vector):
    """Rotation matrix of a rotation vector [rad]."""
    angle = numpy.linalg.norm(vector)
    if angle == 0.0:
        return numpy.eye(3)
    x, y, z = vector / angle
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def vector_of(rotation):
    """Rotation vector of a rotation matrix, for less than half a turn."""
    axis = 0.5 * numpy.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                              rotation[1, 0] - rotation[0, 1]])
    sine = numpy.linalg.norm(axis)
    angle = numpy.arctan2(sine, 0.5 * (numpy.trace(rotation) - 1.0))
    return axis * (angle / sine if sine > 0.0 else 1.0)


def pose_errors(run):
    """Errors (n x 6) and covariances (n x 6 x 6) of the pose changes, as the covariance of
    OdometryResult is defined. A change is relative to the pair that was dt_s earlier."""
    truth = read_poses(run.drive / 'poses.txt')
    times = numpy.array([1e-9 * int(pair['stamp_ns']) for pair in run.pairs])
    errors, covariances = [], []
    for index, pair in enumerate(run.pairs):
        if pair['state'] in ('ok', 'degraded'):
            previous = numpy.argmin(numpy.abs(times - times[index] + float(pair['dt_s'])))
            before, after = truth[previous], truth[index]
            rotation = before[:, :3].T @ after[:, :3]
            translation = before[:, :3].T @ (after[:, 3] - before[:, 3])
            estimate = [float(pair[axis]) for axis in
                        ('x_m', 'y_m', 'z_m', 'rx_rad', 'ry_rad', 'rz_rad')]
            errors.append(numpy.concatenate([
                translation - estimate[:3], vector_of(rotation @ rotation_of(
                    numpy.array(estimate[3:])).T)]))
            upper = numpy.array([[float(pair['covariance_%s_%s' % (AXES[min(i, j)],
                                                                   AXES[max(i, j)])])
                                  for j in range(6)] for i in range(6)])
            covariances.append(upper)
    return numpy.reshape(errors, (-1, 6)), numpy.reshape(covariances, (-1, 6, 6))


def normalized(errors, covariances, part):
    """NEES for a slice of the axes."""
    return numpy.einsum('ni,ni->n', errors[:, part], numpy.linalg.solve(
        covariances[:, part, part], errors[:, part, None])[:, :, 0])


def make_consistency_table(runs, drives):
    rows = []
    for drive in drives:
        errors, covariances = pose_errors(runs[drive, 'default'])
        nees = normalized(errors, covariances, slice(0, 6))
        rows.append([drive.name, '%d' % len(nees), '%.2f' % nees.mean(),
                     '%.1f %%' % (100 * numpy.mean(nees > BOUND_99)),
                     '%.2f' % normalized(errors, covariances, slice(0, 3)).mean(),
                     '%.2f' % normalized(errors, covariances, slice(3, 6)).mean()])
    return ['drive', 'pairs', 'mean NEES (6)', 'outside the 99 % bound (1 %)',
            'of the translation (3)', 'of the rotation (3)'], rows
