"""Tables of the pages, as markdown, from what the experiments have written."""
import re

import numpy

from rotrocc_tools.tables import markdown, read_table

ERRORS = ('translation_percent', 'rotation_deg_per_m')
NAMES = [('0([0-9])_', r'0\1'), ('raw', 'raw'), ('euroc', 'EuRoC'), ('karlsruhe', 'Karlsruhe'), ('street', 'street'),
         ('handheld', 'handheld'), ('rover', 'rover')]
UNSCORED = ('street', 'handheld', 'rover')
FOLDS = {"KITTI's car": ('0', 'raw'), 'Karlsruhe': ('Karlsruhe',), 'EuRoC': ('EuRoC',)}
STAGES = ('pyramids', 'corners', 'disparity', 'tracking', 'estimation')


def name_of(drive):
    """Short name of a clip; that of a drive is its own."""
    for pattern, name in NAMES:
        match = re.match(pattern, drive)
        if match:
            return match.expand(name)
    return drive


def compact(value, digits):
    """Without the zero before the point."""
    return re.sub(r'^(-?)0\.', r'\1.', '%.*f' % (digits, value)) if numpy.isfinite(value) else ''


def values(rows, column):
    """Those that are known."""
    found = numpy.array([float(row[column]) for row in rows])
    return found[numpy.isfinite(found)]


def mean(rows, column):
    found = values(rows, column)
    return numpy.exp(numpy.log(found).mean()) if len(found) else numpy.nan


def total(rows, column):
    return sum(int(row[column]) for row in rows)


def having(rows, **wanted):
    return [row for row in rows if all(row[column] == str(value) for column, value in wanted.items())]


def each_value(rows, column):
    """In the order of the rows."""
    return list(dict.fromkeys(row[column] for row in rows))


def scored(rows):
    return [row for row in rows if numpy.isfinite(float(row['translation_percent']))]


def right_images(rows):
    """Mean errors and lost pairs by setting and N."""
    every = each_value(rows, 'every')
    table = []
    for setting in each_value(rows, 'setting'):
        cells = []
        for n in every:
            runs = having(rows, setting=setting, every=n)
            lost = total(runs, 'lost')
            cells.append('%s %s' % (compact(mean(runs, ERRORS[0]), 3), compact(mean(runs, ERRORS[1]), 4)) +
                         (', %d lost' % lost if lost else ''))
        table.append([setting.replace('default', 'as they are').replace('right ', ''), *cells])
    return markdown(['right images', *['1 of %s' % n for n in every]], table)


def by_clip(rows):
    """Errors of the default by clip and N."""
    every = each_value(rows, 'every')
    table = []
    for drive in each_value(scored(rows), 'drive'):
        runs = [having(rows, drive=drive, setting='default', every=n)[0] for n in every]
        table.append([name_of(drive), *[compact(float(run[ERRORS[0]]), 2) for run in runs],
                      *['%.1f' % (1e3 * value) for value in values(runs[:1], ERRORS[1])]] +
                     [''] * (not len(values(runs[:1], ERRORS[1]))))
    return markdown(['clip', *['1 of %s [%%]' % n for n in every], 'rotation, 1 of 1 [0.001 deg/m]'], table)


def by_setting(rows):
    """Translation errors by setting and clip, at N = 1."""
    rows = having(rows, every=1)
    drives = each_value(scored(rows), 'drive')
    table = []
    for setting in each_value(rows, 'setting'):
        runs = having(rows, setting=setting)
        by_drive = [having(runs, drive=drive)[0] for drive in drives]
        table.append([setting, *[compact(float(run[ERRORS[0]]), 2) for run in by_drive], total(runs, 'lost'),
                      total(runs, 'degraded')])
    return markdown(['translation [%]', *map(name_of, drives), 'lost', 'degraded'], table)


def without(rows, names):
    return [row for row in rows if not name_of(row['drive']).startswith(names)]


def ablation(rows):
    """Means of translation, and changes in % without each of the rigs."""
    every = each_value(rows, 'every')
    default = having(rows, setting='default')
    table = []
    for setting in each_value(rows, 'setting'):
        runs = having(rows, setting=setting)
        means = ' '.join(compact(mean(having(runs, every=n), ERRORS[0]), 3) for n in every[:3])
        changes = [' '.join('%+.0f' % (100 * (mean(without(having(runs, every=n), names), ERRORS[0]) / mean(
            without(having(default, every=n), names), ERRORS[0]) - 1)) for names in FOLDS.values())
            for n in every[:3]]
        counts = [' '.join(str(total(having(runs, every=n), state)) for n in every) for state in ('lost', 'degraded')]
        table.append([setting, means, *(changes if setting != 'default' else [''] * len(changes)), *counts])
    return markdown(['changed', 'translation [%], 1 of ' + ', '.join(every[:3]),
                     *['change [%%], 1 of %s' % n for n in every[:3]], 'lost', 'degraded'], table)


def by_drive(rows):
    """Rows by drive; streets along KITTI's poses as one."""
    groups = {}
    for row in rows:
        groups.setdefault('along KITTI' if row['drive'].startswith('along') else name_of(row['drive']), []).append(row)
    return groups


def covariance(rows, setting):
    """Errors of motions and their standard deviations, at N = 1."""
    table = []
    for name, runs in by_drive(having(rows, setting=setting, every=1)).items():
        numbers = [values(runs, column).mean() for column in ('error_mm', 'sigma_mm', 'nees_translation', 'nees_rotation',
                                                              'nees', 'outside_99_percent') if len(values(runs, column))]
        if numbers:
            table.append([name, total(runs, 'pairs'), *['%.2g' % number if number < 1 else '%.1f' % number
                                                        for number in numbers]])
    return markdown(['drive', 'pairs', 'RMS translation error [mm]', 'reported sigma [mm]',
                     'NEES of the translation (3)', 'of the rotation (3)', 'of both (6)', 'outside 99 % (1 %)'], table)


def simulated(rows):
    """Errors by drive and setting; streets along KITTI's poses as one."""
    groups = by_drive(rows)
    settings = each_value(rows, 'setting')
    table = [[name] + [('%.3f' % mean(having(runs, setting=setting), ERRORS[0])) for setting in settings] +
             ['%.2f' % (1e3 * mean(having(runs, setting=setting), ERRORS[1])) for setting in settings[:2]]
             for name, runs in groups.items()]
    rests = [(name, values(having(runs, setting='default'), 'drift_at_rest_mm')) for name, runs in groups.items()]
    stops = ', '.join('%.1f mm in `%s`' % (drift.max(), name) for name, drift in rests if len(drift))
    return markdown(['drive', *['%s [%%]' % setting for setting in settings],
                     *['%s [0.001 deg/m]' % setting for setting in settings[:2]]], table) + (
        '\nLargest drift at a stop: %s.\n' % stops)


def rigs(rows):
    """Errors with and without the correction of the bias."""
    table = []
    for drive in each_value(rows, 'drive'):
        with_it, without_it = [having(rows, drive=drive, setting=setting)[0] for setting in ('default',
                                                                                          'no calibration')]
        bias = re.search(r'(plus|minus)_([\d.]+)', drive)
        true_px = float(bias.group(2)) * (1 if bias.group(1) == 'plus' else -1) if bias else 0.0
        table.append([drive, '%g' % true_px, *['%.3f' % float(run[ERRORS[0]]) for run in (with_it, without_it)]])
    return markdown(['drive', 'bias [px]', 'error [%]', 'without calibration [%]'], table)


def gyroscope(rows):
    table = []
    for n in each_value(rows, 'every'):
        runs = [having(rows, every=n, setting=setting)[0] for setting in ('without', 'gyroscope')]
        cells = [form % (float(run[column])) for column, form in (
            (ERRORS[0], '%.2f'), (ERRORS[1], '%.3f'), ('lost', '%d'), ('tries', '%.2f')) for run in runs]
        table.append([n, '%.0f' % float(runs[0]['largest_rotation_deg']), *cells])
    return markdown(['every nth pair', 'largest rotation [deg]', 'translation [%]: without', 'with',
                     'rotation [deg/m]: without', 'with', 'lost: without', 'with', 'tries: without', 'with'], table)


def limits(folder):
    """The first table of experiments/limits."""
    return (folder / 'limits.md').read_text().split('\n\n')[0].rstrip('\n') + '\n'


def limit_pairs(folder):
    return (folder / 'limits.md').read_text().split('\n\n')[1].rstrip('\n') + '\n'


def time_of(text, stage, column=0):
    """[ms] per pair, from the table of offline_odometry: mean, median, p95, p99."""
    return re.search(r'^ *%s +(.*)$' % stage, text, re.MULTILINE).group(1).split()[column]


def speed(texts):
    """Wall and CPU time by clip, with the default."""
    default = {clip: text for (clip, preset), text in texts.items()
               if preset == 'default' and name_of(clip) not in UNSCORED}
    lines = {'wall': 0, 'wall, p99': 3, 'cpu': 0, 'latency': 0}
    table = [[line, *[time_of(text, line.split(',')[0], column) for text in default.values()]]
             for line, column in lines.items()]
    table += [[stage, *[time_of(text, stage) for text in default.values()]] for stage in STAGES]
    table.append(['odometry memory usage [MB]', *[re.search(r'of which ([\d.]+) MB', text).group(1)
                                                  for text in default.values()]])
    return markdown(['ms per pair', *map(name_of, default)], table)


def presets(rows, texts):
    """Errors of presets, and their CPU time relative to the default's."""
    table = []
    for setting in each_value(rows, 'setting'):
        runs = having(rows, setting=setting)
        means = ['%s %s' % tuple(compact(mean(having(runs, every=n), error), digits)
                                 for error, digits in zip(ERRORS, (3, 4))) for n in each_value(rows, 'every')]
        shares = [float(time_of(text, 'cpu')) / float(time_of(texts[clip, 'default'], 'cpu'))
                  for (clip, preset), text in texts.items() if preset == setting and name_of(clip) not in UNSCORED]
        table.append([setting, '%.2f' % numpy.mean(shares), *means, total(runs, 'lost')])
    return markdown(['preset', 'CPU time', *['1 of %s' % n for n in each_value(rows, 'every')], 'lost'], table)


def fig6(folder):
    """RMS errors of the forward translation by criterion [mm]."""
    table = []
    for path in sorted(folder.glob('fig6_*.csv'), key=lambda path: path.name):
        rows = read_table(path)
        criteria = [name for name in rows[0] if name not in ('frame', 'truth')]
        errors = [1e3 * numpy.sqrt(numpy.mean((values(rows, name) - values(rows, 'truth')) ** 2)) for name in criteria]
        table.append([name_of(path.stem[len('fig6_'):]), *['%.1f' % error for error in errors]])
    return markdown(['drive', *criteria], table)


def criteria(folder):
    """Translation errors by criterion of the paper [%]."""
    rows = read_table(folder / 'summary.csv')
    columns = [name for name in rows[0] if name.endswith(ERRORS[0])]
    return markdown(['drive', *[name[:-len(ERRORS[0]) - 1] for name in columns]],
                    [[name] + ['%.3f' % mean(runs, column) for column in columns]
                     for name, runs in by_drive(rows).items()])
