"""The trajectory as a map in a page: to zoom, to pan, and to ask each pair. The map is Leaflet, which Debian
ships; the page contains it, so it opens offline."""
import json
import os
import pathlib
import re

import numpy

from rotrocc_tools.plot_style import DEGRADED, ESTIMATE, LOST, TEXT, TRUTH

LEAFLET = pathlib.Path('/usr/share/javascript/leaflet')
SCRIPT = pathlib.Path(os.path.realpath(__file__)).with_suffix('.js')
COLOURS = {'truth': TRUTH, 'estimate': ESTIMATE, 'degraded': DEGRADED, 'lost': LOST, 'text': TEXT}


def available():
    """Whether Leaflet is installed; pages then have the map, and otherwise a picture."""
    return (LEAFLET / 'leaflet.min.js').is_file() and (LEAFLET / 'leaflet.css').is_file()


def rounded(values, digits):
    return [round(float(value), digits) for value in values]


def data_of(poses, states):
    """What the map shows: positions from above, and what it says of each pose. x is to the right, z forward."""
    time_s = 1e-9 * (poses['stamp_ns'] - poses['stamp_ns'][0])
    data = {'colours': COLOURS, 'state': list(states), 'time_s': rounded(time_s, 3),
            'path_m': rounded(poses['path_m'], 1), 'height_m': rounded(-poses['y_m'], 2),
            'estimate': [rounded(poses[axis], 2) for axis in ('z_m', 'x_m')]}
    if 'true_x_m' in poses:
        data['truth'] = [rounded(poses['true_' + axis], 2) for axis in ('z_m', 'x_m')]
        data['error_m'] = rounded(numpy.linalg.norm(
            [poses[axis] - poses['true_' + axis] for axis in ('x_m', 'y_m', 'z_m')], axis=0), 3)
        data['step_error_m'] = rounded(numpy.nan_to_num(poses['step_translation_error_m']), 4)
    return data


def text_of(path):
    """Without the files that it names, as a page has none beside it."""
    text = path.read_text(encoding='utf-8')
    return re.sub(r'url\([^)]*\)', 'none', re.sub(r'//# sourceMappingURL=.*', '', text))


def html(poses, states):
    style = text_of(LEAFLET / 'leaflet.css')
    scripts = [text_of(LEAFLET / 'leaflet.min.js'),
               'const data = %s;' % json.dumps(data_of(poses, states), separators=(',', ':')),
               text_of(SCRIPT)]
    return ('<style>\n%s\n#map { background: #fff; border: 1px solid #e2e5e8; border-radius: 6px; }\n'
            '#map .leaflet-container, #map { font: inherit; font-size: 14px; }\n</style>\n<div id="map"></div>\n'
            '%s' % (style, ''.join('<script>\n%s\n</script>\n' % script for script in scripts)))
