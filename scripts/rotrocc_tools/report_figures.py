"""The figures of reports. Each function writes one PNG.

Tables are {column: array}, as tables.read_columns() gives them.
"""
import contextlib

from matplotlib import patches
import numpy

from rotrocc_tools.plot_style import (BLACK, BLUE, DEGRADED, FAINT, GREEN, LOST, ORANGE, SKY, VERMILLION,
                        dress, legend, place_ticks, pyplot, save)

WIDTH_IN = 8.4
OTHER = {'color': FAINT, 'linestyle': (0, (4, 2)), 'linewidth': 1.3}
# From corners to inliers: light to dark.
COUNTS = [('corners', '#DCEAF5', 'corners'),
          ('with_depth', '#B9D5EA', 'with a depth'),
          ('tracked', '#8FBBDC', 'tracked'),
          ('consistent', '#5B9AC6', 'consistent'),
          ('rotation_inliers', '#1F77AF', 'inliers, stage 1'),
          ('translation_inliers', '#0B3C5D', 'stage 2')]
TIMES = [('pyramids_ms', SKY, 'pyramids'), ('corners_ms', ORANGE, 'corners'),
         ('disparity_ms', GREEN, 'disparity'), ('tracking_ms', BLUE, 'tracking'),
         ('estimation_ms', VERMILLION, 'estimation')]


def panels(rows, columns, height_in, **options):
    figure, axes = pyplot.subplots(rows, columns, figsize=(WIDTH_IN, height_in), squeeze=False,
                                   **options)
    for panel in axes.flat:
        dress(panel)
    return figure, axes


def plot_errors(by_length, by_speed, path, other=None, of_other='earlier'):
    """Translation and rotation error by length and speed of the segments, as the devkit draws them.
    `other` has two tables to compare with, `of_other` says which."""
    figure, axes = panels(2, 2, 4.6, sharey='row')
    bins = [('length_m', 1.0, 'length of the segment [m]'), ('speed_mps', 3.6, 'speed [km/h]')]
    errors = [('translation_percent', 'translation error [%]', BLUE, 'o'),
              ('rotation_deg_per_m', 'rotation error [deg/m]', ORANGE, 's')]
    for column, (bin_name, scale, bin_label) in enumerate(bins):
        table = (by_length, by_speed)[column]
        for row, (name, label, color, marker) in enumerate(errors):
            panel = axes[row, column]
            if other and len(other[column][bin_name]):
                panel.plot(scale * other[column][bin_name], other[column][name], **OTHER)
            panel.plot(scale * table[bin_name], table[name], marker=marker, color=color,
                       markersize=5, linewidth=1.8, clip_on=False, zorder=3)
            panel.set_xlabel(bin_label)
            place_ticks(panel.xaxis, 9)
            if column == 0:
                panel.set_ylabel(label)
    for row in axes:
        row[0].set_ylim(0, 1.12 * row[0].get_ylim()[1])
    figure.tight_layout(h_pad=1.6, w_pad=1.6, rect=(0, 0, 1, 0.95 if other else 1))
    if other:
        lines = [axes[0, 0].lines[-1], axes[1, 0].lines[-1], axes[0, 0].lines[0]]
        legend(figure, lines, ['translation', 'rotation', of_other], loc='upper right', ncol=3,
               bbox_to_anchor=(0.985, 0.99))
    save(figure, path)


def shade(panel, time_s, states):
    """Shades degraded and lost pairs."""
    edges = numpy.concatenate([time_s[:1], 0.5 * (time_s[1:] + time_s[:-1]), time_s[-1:]])
    for state, color, opacity in (('degraded', DEGRADED, 0.22), ('lost', LOST, 0.32)):
        inside = numpy.concatenate([[False], states == state, [False]])
        begins = numpy.flatnonzero(inside[1:] & ~inside[:-1])
        ends = numpy.flatnonzero(~inside[1:] & inside[:-1])
        for begin, end in zip(begins, ends):
            panel.axvspan(edges[begin], edges[end], color=color, alpha=opacity, linewidth=0)


def time_axis(panel, time_s):
    panel.set_xlabel('time [s]')
    panel.set_xlim(time_s[0], max(time_s[-1], time_s[0] + 1e-3))
    place_ticks(panel.xaxis, 10)


def robust_top(values, margin=1.15):
    """An upper limit that ignores single outliers."""
    values = values[numpy.isfinite(values)]
    if not len(values) or values.max() <= 0:
        return 1.0
    return margin * min(values.max(), 3.0 * numpy.percentile(values, 99))


def plot_steps(poses, states, path):
    """Errors from pose to pose, and the speed, over time. `states` has the state of each pose."""
    time_s = 1e-9 * (poses['stamp_ns'] - poses['stamp_ns'][0])
    speed = numpy.concatenate([[numpy.nan], numpy.diff(poses['path_m']) / numpy.diff(time_s)])
    rows = [(3.6 * speed, 'speed [km/h]', FAINT)]
    if 'step_translation_error_m' in poses:
        rows = [(1e3 * poses['step_translation_error_m'], 'translation [mm]', BLUE),
                (1e3 * poses['step_rotation_error_deg'], 'rotation [mdeg]', ORANGE)] + rows
    figure, axes = panels(len(rows), 1, 0.6 + 1.35 * len(rows), sharex=True)
    for panel, (values, label, color) in zip(axes[:, 0], rows):
        shade(panel, time_s, states)
        panel.plot(time_s, values, color=color, linewidth=1.0)
        panel.set_ylabel(label)
        panel.set_ylim(0, robust_top(values))
        place_ticks(panel.yaxis, 4)
    time_axis(axes[-1, 0], time_s)
    figure.align_ylabels(axes[:, 0])
    figure.tight_layout(h_pad=0.8, rect=(0, 0, 1, 1 - 0.22 / figure.get_figheight()))
    handles = [patches.Patch(color=color, alpha=0.35, linewidth=0) for color in (DEGRADED, LOST)]
    counts = ['%s: %d of %d pairs' % (state, numpy.count_nonzero(states == state), len(states))
              for state in ('degraded', 'lost')]
    legend(figure, handles, counts, loc='upper right', ncol=2, bbox_to_anchor=(0.985, 0.995))
    save(figure, path)


@contextlib.contextmanager
def timeline(label, time_s, path):
    """A panel to draw on, whose legend is above it."""
    figure, axes = panels(1, 1, 2.9)
    panel = axes[0, 0]
    panel.set_ylabel(label)
    yield panel
    time_axis(panel, time_s)
    handles, labels = panel.get_legend_handles_labels()
    figure.tight_layout(rect=(0, 0, 1, 0.91))
    legend(figure, handles, labels, loc='upper left', ncol=len(labels),
           bbox_to_anchor=(panel.get_position().x0, 0.985))
    save(figure, path)


def plot_counts(pairs, time_s, path):
    """Features left after each stage."""
    with timeline('features', time_s, path) as panel:
        for name, color, label in COUNTS:
            panel.fill_between(time_s, pairs[name], color=color, linewidth=0, label=label)
        panel.set_ylim(0, 1.05 * max(1, pairs['corners'].max()))


def plot_times(pairs, time_s, path):
    """Stacked times of the stages."""
    names, colors, labels = zip(*TIMES)
    with timeline('wall time [ms]', time_s, path) as panel:
        panel.stackplot(time_s, [pairs[name] for name in names], linewidth=0, colors=colors, labels=labels)
        panel.plot(time_s, pairs['wall_ms'], color=BLACK, linewidth=0.6, label='whole pair')
        panel.set_ylim(0, robust_top(pairs['wall_ms']))


def plot_bias(pairs, time_s, path):
    """Estimated disparity bias with its standard deviation, and the applied correction."""
    bias, sigma = pairs['bias_estimated_px'], pairs['bias_sigma_px']
    settled = sigma <= 2 * numpy.median(sigma)  # all but the first pairs
    low = min(0.0, (bias - 2 * sigma)[settled].min())
    high = max(0.0, (bias + 2 * sigma)[settled].max())
    margin = max(0.08 * (high - low), 0.02)
    with timeline('disparity bias [px]', time_s, path) as panel:
        panel.axhline(0.0, color=FAINT, linewidth=0.8)
        for factor, opacity in ((2, 0.13), (1, 0.25)):
            panel.fill_between(time_s, bias - factor * sigma, bias + factor * sigma, color=BLUE, alpha=opacity,
                               linewidth=0, label='%d sigma' % factor)
        panel.plot(time_s, bias, color=BLUE, linewidth=1.6, label='estimated')
        panel.plot(time_s, pairs['bias_applied_px'], color=VERMILLION, linewidth=1.2, label='applied')
        panel.set_ylim(low - margin, high + margin)
