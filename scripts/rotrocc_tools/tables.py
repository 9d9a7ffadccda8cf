"""Tables: CSV files of the programs and of reports, and markdown."""
import contextlib
import csv
import os

import numpy


def read_table(path):
    """[{column: text}]"""
    with open(str(path)) as file:
        return list(csv.DictReader(file))


@contextlib.contextmanager
def replaced(path):
    """A file to write, which replaces that of the path at once, so that nobody reads half of it."""
    part = path.with_suffix('.part')
    with open(str(part), 'w', encoding='utf-8') as file:
        yield file
    os.replace(str(part), str(path))


def write_table(path, names, rows):
    with replaced(path) as file:
        csv.writer(file, lineterminator='\n').writerows([names, *rows])


def markdown(header, rows):
    return ''.join('| %s |\n' % ' | '.join(str(cell) for cell in cells)
                   for cells in [header, ['---'] * len(header), *rows])


def read_columns(path):
    """{column: array}, numeric if all cells are numbers."""
    with open(str(path)) as file:
        names, *rows = csv.reader(file)
    columns = {}
    for name, cells in zip(names, zip(*rows) if rows else [()] * len(names)):
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
    """The distance traveled up to each position, n x 3 [m]."""
    steps = numpy.linalg.norm(numpy.diff(positions_m, axis=0), axis=1)
    return numpy.concatenate([[0.0], numpy.cumsum(steps)])
