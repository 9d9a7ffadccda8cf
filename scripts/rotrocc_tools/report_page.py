"""Self-contained HTML pages: no external files, embedded pictures."""
import base64
import html

from rotrocc_tools.tables import replaced

STYLE = '''
body { margin: 0; background: #f6f7f8; color: #222; font: 16px/1.5 system-ui, "DejaVu Sans", Arial, sans-serif; }
main { max-width: 1100px; margin: 0 auto; padding: 32px 20px 48px; }
h1 { margin: 0; font-size: 28px; line-height: 1.25; overflow-wrap: anywhere; }
h2 { margin: 0 0 4px; font-size: 19px; }
p { margin: 4px 0 12px; color: #555; }
main > section { margin-top: 20px; padding: 20px 24px 16px; background: #fff; border: 1px solid #e2e5e8; border-radius: 10px; }
.tiles { display: grid; grid-template-columns: repeat(3, 1fr); gap: 12px; margin-top: 20px; }
.tiles.four { grid-template-columns: repeat(4, 1fr); }
@media (max-width: 700px) { .tiles, .tiles.four { grid-template-columns: 1fr 1fr; } }
.tile { padding: 12px 16px; background: #fff; border: 1px solid #e2e5e8; border-radius: 10px; }
.tile b { display: block; font-size: 24px; line-height: 1.3; white-space: nowrap; }
.tile b small { font-size: 15px; font-weight: normal; color: #555; }
.tile span { color: #555; font-size: 14px; }
img { display: block; width: 100%; max-width: 900px; height: auto; margin: 8px auto; }
summary { margin: 12px 0 4px; color: #0072B2; cursor: pointer; }
.scroll { overflow-x: auto; }
.columns { display: grid; grid-template-columns: repeat(auto-fit, minmax(390px, 1fr)); gap: 0 40px; align-items: start; }
table { border-collapse: collapse; margin: 10px 0; font-size: 14.5px; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: 5px 7px; text-align: right; border-bottom: 1px solid #e8eaec; white-space: nowrap; }
th { color: #555; font-weight: 600; vertical-align: bottom; white-space: normal; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
tr.total td { font-weight: 600; border-top: 2px solid #999; border-bottom: 0; }
a { color: #0072B2; }
.better { color: #0072B2; } .worse { color: #B34700; font-weight: 600; }
'''


def text(words):
    return html.escape(str(words))


def link(target, words):
    return '<a href="%s">%s</a>' % (html.escape(target, quote=True), text(words))


def links(files):
    return ', '.join(link(name, name) for name in files)


def tiles(entries):
    """`entries`: (value, unit, label)."""
    four = ' four' if len(entries) % 4 == 0 else ''
    return '<div class="tiles%s">%s</div>\n' % (four, ''.join(
        '<div class="tile"><b>%s <small>%s</small></b><span>%s</span></div>'
        % tuple(text(part) for part in entry) for entry in entries))


def picture(path, description):
    with open(str(path), 'rb') as file:
        data = base64.b64encode(file.read()).decode()
    return '<img alt="%s" src="data:image/png;base64,%s">\n' % (
        html.escape(description, quote=True), data)


def table(header, rows, total=None):
    """Cells are HTML; `total` is an additional, highlighted row."""
    def line(cells, tag, attribute=''):
        return '<tr%s>%s</tr>\n' % (attribute, ''.join(
            '<%s>%s</%s>' % (tag, cell, tag) for cell in cells))
    body = ''.join(line(row, 'td') for row in rows)
    if total:
        body += line(total, 'td', ' class="total"')
    return '<div class="scroll"><table>\n%s%s</table></div>\n' % (line(header, 'th'), body)


def columns(*parts):
    """Side by side if they fit."""
    return '<div class="columns">%s</div>\n' % ''.join(parts)


def section(title, note, *parts):
    return '<section><h2>%s</h2>\n<p>%s</p>\n%s</section>\n' % (text(title), note, ''.join(parts))


def details(summary, *parts):
    """Folded away at first."""
    return '<details><summary>%s</summary>%s</details>\n' % (text(summary), ''.join(parts))


def write_page(path, title, note, *parts):
    page = ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            '<title>%s</title>\n<style>%s</style>\n</head>\n<body>\n<main>\n<h1>%s</h1>\n<p>%s</p>\n'
            '%s</main>\n</body>\n</html>\n'
            % (text(title), STYLE, text(title), note, ''.join(parts)))
    with replaced(path) as file:
        file.write(page)
