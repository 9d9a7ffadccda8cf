"""Tables and picture of experiments/limits."""
import itertools

from matplotlib.patches import Patch
from rotrocc_tools.plot_style import BLUE, FAINT, GREEN, TEXT, VERMILLION, YELLOW, legend, pyplot, save
from stresses import LORRIES, UNSEEN

ZONES = {'fine': ('fine', GREEN), 'degraded': ('degraded, and reported', YELLOW),
         'wrong': ('silently wrong', VERMILLION)}
ROW_IN = 0.42


def limit_table(limits, stresses, configs):
    """`limits`: {(configuration, stress): (last fine level, first wrong level)}"""
    header = ['stress', 'unit', 'levels'] + ['%s: %s' % (config, what) for config in configs
                                             for what in ('last fine level', 'first wrong level')]
    return header, [[stress.title, stress.unit, '%g to %g' % (stress.levels[0], stress.levels[-1]),
                     *[text for config in configs for text in limits[config, stress.name]]]
                    for stress in stresses]


def count_table(runs, configs):
    """Pairs of the stresses that images can show."""
    header = ['configuration', 'runs', 'pairs', 'ok', 'degraded', 'lost', 'ok, but off by more than 6 sigma',
              'per 1000 ok pairs', 'per 1000 ok pairs, without trucks', 'ok, but a Mahalanobis distance above 6']
    rows = []
    for config in configs:
        of_config = [row for row in runs if row['config'] == config and row['stress'] not in UNSEEN]
        counts = [sum(int(row[name]) for row in of_config)
                  for name in ('pairs', 'ok', 'degraded', 'lost', 'wrong', 'wrong_by_distance')]
        others = [row for row in of_config if row['stress'] not in LORRIES]
        rows.append([config, len(of_config), *counts[:5], wrong_of_1000(of_config), wrong_of_1000(others),
                     counts[5]])
    return header, rows


def wrong_of_1000(runs):
    ok, wrong = (sum(int(row[name]) for row in runs) for name in ('ok', 'wrong'))
    return '%.1f' % (1000 * wrong / max(1, ok))


def wrong_table(runs):
    names = ['config', 'stress', 'level', 'seed', 'wrong_pairs']
    return names[:4] + ['pair:sigma'], [[row[name] for name in names] for row in runs if int(row['wrong'])]


def spans(zones, rungs):
    """[(first rung, number of rungs, zone)]; a rung that was not measured has the zone of the last one before."""
    changes = [next(same) for _, same in itertools.groupby(sorted(zones.items()), key=lambda entry: entry[1])]
    ends = [rung for rung, _ in changes[1:]] + [rungs]
    return [(rung, end - rung, zone) for (rung, zone), end in zip(changes, ends)]


def draw_stress(axes, y, stress, zones, configs):
    """A bar for each configuration; rungs have equal widths."""
    rungs = len(stress.levels)
    height = 0.78 / len(configs)
    for number, config in enumerate(configs):
        middle = y + (number - 0.5 * (len(configs) - 1)) * height
        for first, count, zone in spans(zones[config, stress.name], rungs):
            axes.barh(middle, count / rungs, left=first / rungs, height=0.8 * height, color=ZONES[zone][1],
                      linewidth=0)
            if first > 0:
                axes.text((first + 0.15) / rungs, middle, '%g' % stress.levels[first], fontsize=6.5,
                          color=TEXT, va='center')
    axes.text(-0.01, y, '%s\n%s' % (stress.title, stress.unit), fontsize=8.5, color=TEXT, ha='right', va='center',
              linespacing=1.1)
    axes.text(0.004, y - 0.39 + 0.5 * height, '%g' % stress.levels[0], fontsize=6.5, color=TEXT, va='center')
    axes.text(1.01, y, 'to %g' % stress.levels[-1], fontsize=8, color=FAINT, va='center')


def draw(path, stresses, zones, configs):
    """`zones`: {(configuration, stress): {rung: zone}}. The bars of a stress, from top to bottom: the configurations."""
    figure, axes = pyplot.subplots(figsize=(9, ROW_IN * (len(stresses) + 2)))
    for row, stress in enumerate(stresses):
        draw_stress(axes, row, stress, zones, configs)
    axes.set_xlim(0, 1)
    axes.set_ylim(len(stresses) - 0.45, -0.55)
    axes.set_axis_off()
    top = 1 - 0.6 * ROW_IN / figure.get_figheight()
    figure.subplots_adjust(left=0.27, right=0.93, top=1 - 1.1 * ROW_IN / figure.get_figheight(), bottom=0.01)
    legend(figure, handles=[Patch(color=color, label=text) for text, color in ZONES.values()], ncol=3,
           loc='upper left', bbox_to_anchor=(0.27, 1 - 0.15 * ROW_IN / figure.get_figheight()))
    figure.text(0.27, top, 'bars from top to bottom: %s; numbers: the level where a color starts' % ', '.join(configs),
                fontsize=8.5, color=BLUE, va='top')
    save(figure, path)
