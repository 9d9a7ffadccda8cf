"""The figure of scripts/performance: scaling of the cost."""
from plot_style import BLUE, FAINT, ORANGE, TEXT, VERMILLION, dress, pyplot, save
from speed_runs import CPU, WALL

LINES = [(0, WALL, 'wall, 1 thread', BLUE, 'o'), (1, WALL, 'wall, 2 threads', ORANGE, 's'),
         (1, CPU, 'CPU, 2 threads', VERMILLION, '^')]


def plot_lines(axes, places, results):
    """`results` are pairs of figures, with 1 and 2 threads. Lines are labelled at their ends."""
    ends = []
    for which, figure, label, colour, marker in LINES:
        values = [pair[which][figure] for pair in results]
        axes.plot(places, values, color=colour, marker=marker, markersize=5, linewidth=1.8)
        ends.append([values[-1], label, colour])
    axes.set_xlim(0, places[-1] * 1.4)
    axes.set_ylim(0, None)
    # Move overlapping labels apart.
    gap = 0.06 * axes.get_ylim()[1]
    ends.sort(key=lambda end: end[0])
    for lower, upper in zip(ends, ends[1:]):
        upper[0] = max(upper[0], lower[0] + gap)
    for height, label, colour in ends:
        axes.text(places[-1] * 1.03, height, label, color=colour, fontsize=9, va='center')


def draw(of_features, of_sizes, path):
    """Plots {requested corners: pair of figures} and {'WxH': pair of figures}."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(8.4, 3.4))
    for axes in (left, right):
        dress(axes)
    results = list(of_features.values())
    plot_lines(left, [pair[0]['features tracked'] for pair in results], results)
    left.set_xlabel('features tracked')
    left.set_ylabel('ms a pair')
    left.set_title('by features, KITTI 06', fontsize=10.5, color=TEXT, loc='left')

    megapixels = [int(size.split('x')[0]) * int(size.split('x')[1]) * 1e-6 for size in of_sizes]
    plot_lines(right, megapixels, list(of_sizes.values()))
    right.set_xlabel('megapixels of an image')
    right.set_title('by image size, simulated drive', fontsize=10.5, color=TEXT, loc='left')
    for size, place in zip(of_sizes, megapixels):
        right.annotate(size, (place, 0), xytext=(0, 3), textcoords='offset points', ha='center',
                       fontsize=7, color=FAINT)
    figure.tight_layout(w_pad=2.0)
    save(figure, path)
