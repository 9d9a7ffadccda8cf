"""The figures of a rig check. Tables are {column: array}, as tables.read_columns() gives them."""
from matplotlib import colors, image
import numpy

from rotrocc_tools.plot_style import (BLUE, ORANGE, SKY, TEXT, VERMILLION, dress, legend, place_ticks, pyplot,
                                      save)

WIDTH_IN = 8.4
SIGNED = colors.LinearSegmentedColormap.from_list('signed', [BLUE, SKY, '#F4F4F4', ORANGE, VERMILLION])
SHARE = colors.LinearSegmentedColormap.from_list('share', [VERMILLION, '#F4F4F4', BLUE])


def courses(panels, path):
    """Panels above each other with a common time axis: (label of y, [(time, value, sigma or None, name, color)])."""
    figure, axes = pyplot.subplots(len(panels), 1, figsize=(WIDTH_IN, 0.5 + 1.55 * len(panels)), sharex=True,
                                   squeeze=False)
    for panel, (label, lines) in zip(axes.flat, panels):
        dress(panel)
        place_ticks(panel.yaxis, 4)
        panel.set_ylabel(label)
        for time_s, value, sigma, name, color in lines:
            style = {'marker': 'o', 'markersize': 4} if len(time_s) < 40 else {'linewidth': 1.2}
            panel.plot(time_s, value, color=color, label=name, **style)
            if sigma is not None:
                panel.fill_between(time_s, value - sigma, value + sigma, color=color, alpha=0.2, linewidth=0)
        if len(lines) > 1:
            legend(panel, loc='lower left', bbox_to_anchor=(0.0, 1.0), ncol=len(lines))
    axes[-1, 0].set_xlabel('time [s]')
    figure.align_ylabels()
    figure.tight_layout()
    save(figure, path)


def largest_px(*values):
    """Of finite values, for a symmetric scale: at least a quarter of a pixel, below which nothing matters."""
    finite = numpy.concatenate([numpy.abs(value[numpy.isfinite(value)]) for value in values])
    return max(finite.max() if finite.size else 0.0, 0.25)


def draw_map(panel, table, values, size, picture, color_map, limits):
    """Cells of a table over a faint picture of the camera."""
    if picture is not None:
        panel.imshow(picture, cmap='gray', vmin=0, vmax=255, extent=(0, size[0], size[1], 0), alpha=0.45)
    xs, ys = numpy.unique(table['x_px']), numpy.unique(table['y_px'])
    width = numpy.diff(xs).min() if len(xs) > 1 else size[0]
    height = numpy.diff(ys).min() if len(ys) > 1 else size[1]
    cells = numpy.full((int(round(size[1] / height)), int(round(size[0] / width))), numpy.nan)
    rows = numpy.clip((table['y_px'] / height).astype(int), 0, cells.shape[0] - 1)
    columns = numpy.clip((table['x_px'] / width).astype(int), 0, cells.shape[1] - 1)
    cells[rows, columns] = values
    drawn = panel.imshow(cells, cmap=color_map, vmin=limits[0], vmax=limits[1], alpha=0.75,
                         extent=(0, size[0], size[1], 0), interpolation='nearest')
    panel.set_xlim(0, size[0])
    panel.set_ylim(size[1], 0)
    panel.set_xticks([])
    panel.set_yticks([])
    for side in panel.spines.values():
        side.set_visible(False)
    return drawn


def maps(parts, left_png, path, color_map, limits, label):
    """Maps one above the other, with one color bar: (title, table, values, arrows or None)."""
    picture = image.imread(str(left_png)) * 255.0
    size = picture.shape[1], picture.shape[0]
    height_in = WIDTH_IN * 0.84 * size[1] / size[0]
    figure, axes = pyplot.subplots(len(parts), 1, figsize=(WIDTH_IN, (height_in + 0.35) * len(parts) + 0.2),
                                   squeeze=False, constrained_layout=True)
    for panel, (title, table, values, arrows) in zip(axes.flat, parts):
        drawn = draw_map(panel, table, values, size, picture, color_map, limits)
        panel.set_title(title, fontsize=10, color=TEXT, loc='left')
        if arrows:
            longest_px = 0.09 * size[1]
            panel.quiver(table['x_px'], table['y_px'], 0 * values, values * longest_px / limits[1], angles='xy',
                         scale_units='xy', scale=1.0, color='black', width=0.0016)
    bar = figure.colorbar(drawn, ax=list(axes.flat), shrink=0.9, pad=0.015, aspect=30)
    bar.set_label(label, color=TEXT)
    bar.outline.set_visible(False)
    save(figure, path)


def mask(left_png, mask_png, path):
    """The proposed mask, tinted over the picture."""
    picture = numpy.repeat(image.imread(str(left_png))[:, :, None], 3, axis=2)
    masked = image.imread(str(mask_png)) > 0.5
    picture[masked] = 0.5 * picture[masked] + 0.5 * numpy.array(colors.to_rgb(VERMILLION))
    figure, panel = pyplot.subplots(figsize=(WIDTH_IN, WIDTH_IN * picture.shape[0] / picture.shape[1]))
    panel.imshow(picture)
    panel.axis('off')
    figure.subplots_adjust(0, 0, 1, 1)
    save(figure, path)
