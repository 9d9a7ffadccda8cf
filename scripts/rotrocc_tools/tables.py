"""Tables: CSV files of the programs and of reports, and markdown."""
import csv
import os

import numpy


def read_table(path):
    """[{column: text}]"""
    with open(str(path)) as file:
        return list(csv.DictReader(file))


def write_table(path, names, rows):
    """Replaces the file at once, so that nobody reads half of it."""
    part = path.with_suffix('.part')
    with open(str(part), 'w') as file:
        writer = csv.writer(file, lineterminator='\n')
        writer.writerow(names)
        writer.writerows(rows)
    os.replace(str(part), str(path))


def markdown(header, rows):
    return ''.join('| %s |\n' % ' | '.join(str(cell) for cell in cells)
                   for cells in [header, ['---'] * len(header), *rows])


def read_columns(path):
    """{column: array}, numeric if all cells are numbers."""
    with open(str(path)) as file:
        rows = list(csv.reader(file))
    columns = {}
    for name, cells in zip(rows[0], zip(*rows[1:]) if rows[1:] else [()] * len(rows[0])):
        kind = numpy.int64 if name.endswith('_ns') else float
        try:
            columns[name] = numpy.array(cells, dtype=kind)
        except ValueError:
            columns[name] = numpy.array(cells)
    return columns


def positions(poses, prefix=''):
    """n x 3 positions of the estimate, or of the ground truth with the prefix 'true_'."""
    return numpy.stack([poses['%s%s_m' % (prefix, axis)] for axis in 'xyz'], axis=1)


def path_lengths(positions_m):
    """The distance travelled up to each position, n x 3 [m]."""
    steps = numpy.linalg.norm(numpy.diff(positions_m, axis=0), axis=1)
    return numpy.concatenate([[0.0], numpy.cumsum(steps)])
