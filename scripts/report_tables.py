"""Reads the tables of reports."""
import csv

import numpy


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


def states_of(poses, pairs):
    """The state of the odometry at each pose; '' if unknown."""
    states = numpy.full(len(poses['stamp_ns']), '', dtype='U16')
    if pairs is None:
        return states
    known = dict(zip(pairs['stamp_ns'], pairs['state']))
    for i, stamp_ns in enumerate(poses['stamp_ns']):
        states[i] = known.get(stamp_ns, '')
    if not all(states):
        raise ValueError('the stamps of poses and statistics differ: both must be from the same '
                         'run, and poses in KITTI format need --times')
    return states
