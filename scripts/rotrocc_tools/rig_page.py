"""The page of a rig check, from what check_rig has written into a folder."""
import re

import numpy
import yaml

from rotrocc_tools import report_page as page
from rotrocc_tools import rig_figures as figures
from rotrocc_tools.plot_style import BLUE, ORANGE
from rotrocc_tools.tables import read_columns

FINDINGS = 'findings.yaml'
# For a person who has to do something.
WORDS = {'fix': 'fix this', 'acceptable': 'acceptable', 'unknown': 'unknown', 'good': 'good'}
STYLE = '''<style>
.badge { padding: 2px 10px; border-radius: 9px; color: #fff; font-size: 13px; font-weight: 600; }
.badge { white-space: nowrap; } .fix { background: #B34700; } .acceptable { background: #8A6500; }
.unknown { background: #777; } .good { background: #00755A; }
.finding { margin: 14px 0; padding-left: 14px; border-left: 4px solid #ddd; }
.finding.fix, .finding.acceptable, .finding.unknown { background: none; }
.finding.fix { border-color: #B34700; } .finding.acceptable { border-color: #C99700; }
.finding b { margin-left: 8px; } .finding p { margin: 3px 0; }
code { padding: 1px 5px; background: #f0f2f4; border-radius: 4px; font-size: 14px; overflow-wrap: anywhere; }
td.words { white-space: normal; } th, td { text-align: left; }
</style>
'''


def badge(verdict):
    return '<span class="badge %s">%s</span>' % (verdict, WORDS[verdict])


def words_of(text):
    return page.text(text).replace('+-', '&plusmn;')


def with_code(words):
    return re.sub('`([^`]*)`', r'<code>\1</code>', page.text(words))


def card(finding, said):
    """With cost and remedy, unless a card before has said the same."""
    title = '%s: %s' % (page.text(finding['section']), page.text(finding['subject']))
    parts = [badge(finding['verdict']), '<b>%s</b>' % title,
             '<p>%s</p>' % words_of(finding['measured'])]
    advice = finding['cost'], finding['remedy']
    if all(advice) and advice in said:
        parts.append('<p>Cost, and what to do: as above.</p>')
    else:
        parts += ['<p>%s: %s</p>' % (name, with_code(words))
                  for name, words in zip(('Cost', 'To do'), advice) if words]
    said.add(advice)
    return '<div class="finding %s">%s</div>\n' % (finding['verdict'], ''.join(parts))


def cells_of(finding):
    return '</td><td class="words">'.join([page.text(finding['section']), page.text(finding['subject']),
                                           words_of(finding['measured'])])


class RigPage:
    def __init__(self, folder):
        self.folder = folder
        with open(str(folder / FINDINGS), encoding='utf-8') as file:
            self.content = yaml.safe_load(file)
        written = (folder / '.rotrocc_report').read_text().splitlines()  # not what others have there
        self.tables = {name[:-4]: read_columns(folder / name) for name in written if name.endswith('.csv')}

    def has(self, name):
        table = self.tables.get(name)
        return table is not None and all(len(column) for column in table.values())

    def picture(self, name, description, draw, *arguments):
        path = self.folder / (name + '_figure.png')
        draw(*arguments, path)
        return page.picture(path, description)

    def course(self, table, value, name=None, color=BLUE, factor=1.0, sigma=None):
        """A line of figures.courses()."""
        columns = self.tables[table]
        deviation = factor * columns[sigma] if sigma else None
        return columns['time_s'], factor * columns[value], deviation, name, color

    def maps(self, name, description, parts, color_map, limits, label):
        return self.picture(name, description, lambda path: figures.maps(
            parts, self.folder / 'left.png', path, color_map, limits, label))

    def tiles(self):
        verdicts = [finding['verdict'] for finding in self.content['findings']]
        return page.tiles([(verdicts.count(verdict), '', words) for verdict, words in (
            ('fix', 'to fix'), ('acceptable', 'acceptable'), ('unknown', 'not measured'), ('good', 'good'))])

    def findings(self):
        listed = self.content['findings']
        said = set()
        bad = [card(finding, said) for finding in listed if finding['verdict'] != 'good']
        good = [[cells_of(finding)] for finding in listed if finding['verdict'] == 'good']
        note = 'The most severe first.' if bad else 'Nothing needs fixing.'
        table = page.table(['section', 'property', 'measured'], good)
        return page.section('Findings', note, *bad, page.details('%d properties are good' % len(good), table),
                            '<p>%s</p>' % page.text(self.content['not_seen']))

    def corrected(self):
        if 'corrected' not in self.content:
            return ''
        after = {(finding['section'], finding['subject']): finding for finding in self.content['corrected']}
        rows = []
        for before in self.content['findings']:
            finding = after.get((before['section'], before['subject']))
            if before['section'] not in ('rows', 'disparities', 'odometry') or not finding:
                continue
            rows.append(['%s</td><td class="words">%s<br>%s</td><td class="words">%s<br>%s' % (
                page.text(before['subject']), badge(before['verdict']), words_of(before['measured']),
                badge(finding['verdict']), words_of(finding['measured']))])
        return page.section('With the corrected calibration', 'The same recording, checked with the files that were '
                            'written. ' + self.worse_rows(), page.table(['', 'before', 'after'], rows))

    def worse_rows(self):
        """Where the corrected calibration leaves larger row differences, as text; empty if nowhere."""
        if not self.has('rows_map') or not self.has('rows_map_corrected'):
            return ''
        columns = 'x_px', 'y_px', 'row_px', 'sigma_px'
        before, after = ({cell[:2]: cell[2:] for cell in zip(*(self.tables[name][column] for column in columns))}
                         for name in ('rows_map', 'rows_map_corrected'))
        sigmas = {cell: numpy.hypot(before[cell][1], after[cell][1]) for cell in before.keys() & after.keys()}
        common = [cell for cell in sigmas if numpy.isfinite(sigmas[cell])]
        worse = [cell for cell in common if abs(after[cell][0]) - abs(before[cell][0]) > 3.0 * sigmas[cell]]
        return ('In %d of %d parts of the image, rows differ more with it: see the map of rows.'
                % (len(worse), len(common)) if worse else '')

    def inputs(self):
        if not self.has('stamps'):
            return ''
        panels = [('interval [ms]', [self.course('stamps', 'interval_ms')]),
                  ('left - right [ms]', [self.course('stamps', 'left_minus_right_ms')])]
        if numpy.isfinite(self.tables['stamps']['age_ms']).any():  # not in folders of images
            panels.append(('arrival [ms]', [self.course('stamps', 'age_ms')]))
        return page.section('Inputs', 'Time from each left image to the next, its timestamp minus that of the nearest '
                            'right image, and its delay on arrival. All should be flat.',
                            self.picture('stamps', 'stamps over time', figures.courses, panels))

    def photometry(self):
        if not self.has('photometry'):
            return ''

        def both(name, factor=1.0):
            return [self.course('photometry', name + '_left', 'left', BLUE, factor),
                    self.course('photometry', name + '_right', 'right', ORANGE, factor)]
        panels = [('mean gray', both('mean')), ('white [%]', both('saturated', 100.0)),
                  ('black [%]', both('dark', 100.0)),
                  ('gain', [self.course('photometry', 'gain')]),
                  ('offset [gray]', [self.course('photometry', 'offset_gray')])]
        return page.section('Photometry', 'Gray levels of both images, and of the right one relative to the left one where '
                            'both show the same: a gain of 1 and an offset of 0 mean that they are equal.',
                            self.picture('photometry', 'gray levels over time', figures.courses, panels))

    def rows(self):
        if not self.has('rows_map'):
            return ''
        table = self.tables['rows_map']
        limit = figures.largest_px(table['row_px'], table['model_px'])
        parts = [('measured', table, table['row_px'], True), ('explained by the findings', table, table['model_px'], True),
                 ('unexplained', table, table['row_px'] - table['model_px'], True)]
        if self.has('rows_map_corrected'):
            after = self.tables['rows_map_corrected']
            parts.append(('measured with the corrected calibration', after, after['row_px'], True))
        shown = [self.maps('rows', 'row differences over the image', parts, figures.SIGNED, (-limit, limit),
                           'lower in the right image [px]')]
        if self.has('rows_time'):
            shown.append(self.picture('rows_time', 'row differences over time', figures.courses, [
                ('middle of the image [px]', [self.course('rows_time', 'row_px', sigma='sigma_px')])]))
        return page.section('Rows', 'How much lower points are in the right image: zero everywhere for a rectified '
                            'pair. Arrows show it on the same scale as the colors. Changes over time '
                            'mean that the rig bends.', *shown)

    def disparities(self):
        if not self.has('bias_time'):
            return ''
        picture = self.picture('bias_time', 'bias over time', figures.courses, [
            ('bias [px]', [self.course('bias_time', 'bias_px', sigma='sigma_px')])])
        return page.section('Disparities', 'What must be added to disparities so that they agree with the motion, in '
                            'each time window, with one standard deviation.', picture)

    def view(self):
        if not self.has('view_map'):
            return ''
        table = self.tables['view_map']
        with numpy.errstate(divide='ignore', invalid='ignore'):
            agreeing = 100.0 * table['inliers'] / table['features']
        parts = [('features that agree with the motion', table, agreeing, False)]
        shown = [self.maps('view', 'what is seen', parts, figures.SHARE, (0, 100), 'share [%]')]
        if (self.folder / 'mask.png').is_file():
            shown.append('<p>Proposed mask, the file <code>mask.png</code>:</p>')
            shown.append(self.picture('mask', 'proposed mask', figures.mask, self.folder / 'left.png',
                                      self.folder / 'mask.png'))
        return page.section('What is seen', 'Where features agree with the motion: red marks parts of the image where they '
                            'never do, such as the robot itself.', *shown)

    def write(self):
        page.write_page(self.folder / 'index.html', self.content['title'], page.text(self.content['summary']), STYLE,
                        '<p><b>%s</b></p>' % with_code(self.content['advice']), self.tiles(), self.findings(),
                        self.corrected(), self.inputs(), self.photometry(), self.rows(), self.disparities(), self.view())
