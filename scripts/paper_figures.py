"""The plots of paper_experiments. Each function writes one PNG."""
import collections

import numpy

from plot_style import BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILLION, pyplot, save

COLOURS = {'rotrocc': BLUE, 'reprojection': VERMILLION, 'rocc': GREEN, 'truth': BLACK,
           'mean_based': ORANGE, 'std_based': PURPLE}
MARKERS = {'rotrocc': 'o', 'reprojection': 's', 'rocc': '^'}
FEWEST_SEGMENTS = 10  # minimum for a point in Fig. 7 and 8


def finish(figure, path):
    for axes in figure.axes:
        axes.grid(alpha=0.3, lw=0.6)
        for side in ('top', 'right'):
            axes.spines[side].set_visible(False)
    figure.tight_layout()
    save(figure, path, dpi=120)


def plot_fig4(rows, path):
    """Reprojection error and NRE of each feature under the six single-axis motions."""
    motions = collections.OrderedDict()
    for row in rows:
        motions.setdefault(row['motion'], []).append((float(row['re_px']), float(row['nre'])))
    figure, axes = pyplot.subplots(len(motions), 2, figsize=(9, 10), sharex=True)
    for (name, errors), (left, right) in zip(motions.items(), axes):
        errors = numpy.array(errors)
        left.plot(errors[:, 0], lw=0.7, color=COLOURS['reprojection'])
        right.plot(errors[:, 1], lw=0.7, color=COLOURS['rotrocc'])
        left.set_ylabel(name)
        left.set_ylim(0, None)
        right.set_ylim(0, 0.2)
    axes[0, 0].set_title('reprojection error [px]')
    axes[0, 1].set_title('normalized reprojection error')
    for bottom in axes[-1]:
        bottom.set_xlabel('feature')
    finish(figure, path)


def plot_fig5(rows, path):
    """Reprojection error, NRE and DNRE of each feature in a turn."""
    wrong = [i for i, row in enumerate(rows) if float(row['depth_factor']) != 1.0]
    figure, axes = pyplot.subplots(3, 1, figsize=(9, 7), sharex=True)
    for panel, (column, label) in zip(axes, [('re_px', 'RE [px]'), ('nre', 'NRE'), ('dnre', 'DNRE')]):
        values = [float(row[column]) for row in rows]
        panel.plot(values, lw=0.7, color=COLOURS['rotrocc'])
        panel.plot(wrong, [values[i] for i in wrong], 'o', ms=5, color=COLOURS['reprojection'],
                   label='features with a wrong depth')
        panel.set_ylabel(label)
        panel.set_ylim(0, None)
    axes[0].legend(frameon=False, loc='lower right', bbox_to_anchor=(1.0, 1.0))
    axes[-1].set_xlabel('feature')
    finish(figure, path)


def plot_fig6(name, columns, path):
    """Forward translation by frame, and below it the error of each criterion."""
    figure, (above, below) = pyplot.subplots(2, 1, figsize=(9, 5.5), sharex=True)
    truth = columns['truth']
    frames = numpy.arange(1, len(truth) + 1)
    for criterion, values in columns.items():
        above.plot(frames, values, label=criterion, color=COLOURS[criterion],
                   lw=3.0 if criterion == 'truth' else 1.0, alpha=0.3 if criterion == 'truth' else 1)
        if criterion != 'truth':
            below.plot(frames, 1e3 * (values - truth), color=COLOURS[criterion], lw=1.0)
    above.set_ylabel('forward translation [m]')
    above.set_title(name, loc='left')
    above.legend(frameon=False, ncol=4, loc='lower right', bbox_to_anchor=(1.0, 1.0))
    below.axhline(0.0, color=COLOURS['truth'], lw=0.8)
    below.set_ylabel('error [mm]')
    below.set_xlabel('frame')
    finish(figure, path)


def plot_errors(title, tables, path):
    """Translation and rotation error by speed and by path length.

    `tables` has a list of (criterion, key, translation, rotation, segments) for each of the two.
    """
    figure, axes = pyplot.subplots(2, 2, figsize=(9.5, 6.5))
    labels = {'speed_mps': 'speed [m/s]', 'length_m': 'path length [m]'}
    for row, (column, table) in zip(axes, tables.items()):
        criteria = list(collections.OrderedDict((line[0], None) for line in table))
        for criterion in criteria:
            lines = [line for line in table if line[0] == criterion and line[4] >= FEWEST_SEGMENTS]
            keys = [line[1] for line in lines]
            for panel, index in zip(row, (2, 3)):
                # Two criteria may coincide: one is filled and small, the other open and large.
                own = criterion == 'rotrocc'
                panel.plot(keys, [line[index] for line in lines], marker=MARKERS[criterion],
                           ms=4 if own else 9, mfc=COLOURS[criterion] if own else 'none', lw=1.6,
                           color=COLOURS[criterion], label=criterion, clip_on=False)
                if column == 'length_m':
                    panel.set_xscale('log')
                    panel.minorticks_off()
                    panel.set_xticks(keys)
                    panel.set_xticklabels(['%g' % key for key in keys])
        for panel, label in zip(row, ('translation error [%]', 'rotation error [deg/m]')):
            panel.set_xlabel(labels[column])
            panel.set_ylabel(label)
            panel.set_ylim(0, 1.08 * panel.get_ylim()[1])
    lines, names = axes[0, 0].get_legend_handles_labels()
    figure.legend(lines, names, frameon=False, ncol=len(names), loc='upper right')
    axes[0, 0].set_title(title, loc='left')
    finish(figure, path)
