"""Style of all plots. Scripts take pyplot from here: it needs a backend that needs no display."""
import matplotlib
matplotlib.use('Agg')
from matplotlib import pyplot, ticker

# Okabe and Ito's colors, distinguishable with color blindness.
ORANGE, SKY, GREEN, YELLOW, BLUE, VERMILLION, PURPLE, BLACK = (
    '#E69F00', '#56B4E9', '#009E73', '#F0E442', '#0072B2', '#D55E00', '#CC79A7', '#000000')
TRUTH, ESTIMATE = BLUE, ORANGE
DEGRADED, LOST = VERMILLION, BLACK  # the worse, the darker, for those who see no colors
TEXT, FAINT, GRID = '#333333', '#777777', '#DDDDDD'


def dress(axes):
    """Plain axes: a faint grid, no frame."""
    axes.set_axisbelow(True)
    axes.grid(color=GRID, linewidth=0.7)
    axes.tick_params(length=0, colors=FAINT, labelsize=9)
    axes.xaxis.label.set_color(TEXT)
    axes.yaxis.label.set_color(TEXT)
    for side in axes.spines.values():
        side.set_visible(False)


def place_ticks(axis, most):
    """At multiples of 1, 2 or 5 times a power of ten."""
    axis.set_major_locator(ticker.MaxNLocator(most, steps=[1, 2, 5, 10]))


def legend(owner, *arguments, **options):
    """A legend without a frame, of axes or of a figure."""
    made = owner.legend(*arguments, frameon=False, fontsize=9.5, handlelength=1.4,
                        columnspacing=1.4, borderpad=0.0, borderaxespad=0.0, **options)
    for text in made.get_texts():
        text.set_color(TEXT)


def save(figure, path, dpi=150):
    figure.savefig(str(path), dpi=dpi)
    pyplot.close(figure)
