"""Picture of a trajectory: top view, and height along the path."""
from matplotlib import ticker
import numpy

from rotrocc_tools.plot_style import DEGRADED, ESTIMATE, LOST, TEXT, TRUTH, dress, legend, place_ticks, pyplot, save
from rotrocc_tools.tables import path_lengths

PAGE_IN = 8.0


def draw_from_above(axes, estimate, truth):
    if truth is not None:
        axes.plot(truth[:, 0], truth[:, 2], color=TRUTH, linewidth=4.0, solid_capstyle='round', label='truth')
    axes.plot(estimate[:, 0], estimate[:, 2], color=ESTIMATE, linewidth=1.6, label='estimate')
    axes.plot(0.0, 0.0, 'o', color=TEXT, markersize=9, markeredgecolor='white', zorder=4, label='start')
    if truth is not None:
        axes.plot(truth[-1, 0], truth[-1, 2], 's', color=TRUTH, markersize=11,
                  markeredgecolor='white', zorder=3)
    axes.plot(estimate[-1, 0], estimate[-1, 2], 's', color=ESTIMATE, markersize=8,
              markeredgecolor='white', zorder=4, label='end')
    axes.set_xlabel('x, to the right [m]', color=TEXT)
    axes.set_ylabel('z, forward [m]', color=TEXT)


def draw_marks(axes, estimate, marks):
    for name, color, size in (('degraded', DEGRADED, 5), ('lost', LOST, 7)):
        marked = estimate[marks[name]]
        if len(marked):
            axes.plot(marked[:, 0], marked[:, 2], 'X', color=color, markersize=size,
                      markeredgewidth=0, linestyle='none', label=name, zorder=3.5)


def draw_height(axes, estimate, truth):
    if truth is not None:
        axes.plot(path_lengths(truth), -truth[:, 1], color=TRUTH, linewidth=3.0,
                  solid_capstyle='round')
    axes.plot(path_lengths(estimate), -estimate[:, 1], color=ESTIMATE, linewidth=1.4)
    axes.set_xlabel('distance [m]', color=TEXT)
    axes.set_ylabel('height [m]', color=TEXT)
    low, high = axes.get_ylim()
    middle, half = (low + high) / 2.0, max(0.5, 0.55 * (high - low))  # keeps flat roads flat
    axes.set_ylim(middle - half, middle + half)
    place_ticks(axes.yaxis, 4)
    place_ticks(axes.xaxis, 8)
    axes.margins(x=0.02)


def limits(estimate, truth):
    """Ranges of x and z with a margin, z no longer than x and at least half as long."""
    points = estimate if truth is None else numpy.vstack([estimate, truth])
    low, high = points[:, [0, 2]].min(axis=0), points[:, [0, 2]].max(axis=0)
    longest = max(1.0, (high - low).max())
    span = 1.12 * numpy.array([longest, max(0.5 * longest, high[1] - low[1])])
    middle = (low + high) / 2.0
    return middle - span / 2.0, middle + span / 2.0


def draw(estimate, truth, path, marks):
    """Writes a PNG of positions [m], n x 3. `marks` flags the estimated poses: {'degraded': ..., 'lost': ...}."""
    low, high = limits(estimate, truth)
    width_in = PAGE_IN - 1.1
    above_in = width_in * (high - low)[1] / (high - low)[0]
    below_in = 1.2
    top_in = 0.45
    page_in = top_in + above_in + 0.85 + below_in + 0.6

    figure = pyplot.figure(figsize=(PAGE_IN, page_in))
    left, width = 0.8 / PAGE_IN, width_in / PAGE_IN
    below = figure.add_axes([left, 0.6 / page_in, width, below_in / page_in])
    above = figure.add_axes([left, (0.6 + below_in + 0.85) / page_in, width, above_in / page_in])
    for axes in (above, below):
        dress(axes)
    draw_from_above(above, estimate, truth)
    draw_marks(above, estimate, marks)
    draw_height(below, estimate, truth)
    above.set_xlim(low[0], high[0])
    above.set_ylim(low[1], high[1])
    place_ticks(above.xaxis, 11)
    above.yaxis.set_major_locator(ticker.MultipleLocator(numpy.diff(above.get_xticks())[0]))  # squares
    for axes in (above, below):  # figure.align_ylabels needs a newer matplotlib than Debian 11's
        axes.yaxis.set_label_coords(-0.065, 0.5)

    legend(figure, *above.get_legend_handles_labels(), loc='upper left', ncol=6,
           bbox_to_anchor=(left, 1.0 - (top_in - 0.37) / page_in))
    save(figure, path)
