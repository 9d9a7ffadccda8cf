"""The errors of features under wrong motions, without noise: Fig. 4 and 5 of the paper.

A motion is a rotation (3 x 3) and a translation [m], which map points of the current camera to the keyframe's.
"""
import numpy
from PIL import Image

from errors import rotation_of
from rotrocc_tools.tables import write_table

COLUMNS = ['motion', 'feature', 'x_px', 'y_px', 'depth_m', 'depth_factor', 're_px', 'nre', 'dnre']
SPACING_PX = 16  # of the features, which are a grid
FARTHEST_M = 200.0
WRONG_DEPTHS = 5  # in Fig. 5


class Features:
    """What a grid of pixels of the left camera sees in the first pair of a drive with its truth, by rows."""

    def __init__(self, drive):
        projection = numpy.array((drive / 'calib.txt').read_text().split()[1:13], float)
        self.focal_px, self.centre_px = projection[0], projection[[2, 6]]
        depth_m = numpy.asarray(Image.open(str(drive / 'depth/000000.tiff')))
        rows, columns = numpy.mgrid[SPACING_PX // 2:depth_m.shape[0]:SPACING_PX,
                                    SPACING_PX // 2:depth_m.shape[1]:SPACING_PX].reshape(2, -1)
        depths_m = depth_m[rows, columns]
        rays = numpy.stack([*((numpy.stack([columns, rows]) - self.centre_px[:, None]) / self.focal_px),
                            numpy.ones(len(rows))], axis=1)
        self.points_m = (depths_m[:, None] * rays)[(depths_m > 0.0) & (depths_m < FARTHEST_M)]

    def project(self, points_m):
        return self.focal_px * points_m[:, :2] / points_m[:, 2:] + self.centre_px

    def errors(self, true, assumed, depth_factors):
        """The reprojection error [px] (Eq. 2) of each feature, and that over its flow (Eq. 8) and over its flow
        without rotation (Eq. 24). The assumed depth of a feature is its true one times its factor."""
        rotated = (depth_factors[:, None] * self.points_m) @ assumed[0].T  # Eq. 27
        keyframe_px = self.project(self.points_m @ true[0].T + true[1])
        error, flow, translation_flow = [numpy.linalg.norm(keyframe_px - self.project(points), axis=1)
                                         for points in (rotated + assumed[1], self.points_m, rotated)]
        return error, error / flow, error / translation_flow

    def rows(self, name, true, assumed, depth_factors=None):
        """Of a table with COLUMNS."""
        count = len(self.points_m)
        factors = numpy.ones(count) if depth_factors is None else depth_factors
        return zip([name] * count, range(count), *self.project(self.points_m).T, self.points_m[:, 2], factors,
                   *self.errors(true, assumed, factors))


def motion(amounts):
    """Of pitch, yaw and roll [deg] and a translation [m], as R_z R_y R_x above Eq. 4."""
    pitch, yaw, roll = numpy.radians(amounts[:3])[:, None] * numpy.eye(3)
    return rotation_of(roll) @ rotation_of(yaw) @ rotation_of(pitch), amounts[3:]


def write_fig4(features, path):
    """Pitch, yaw and roll of 3 deg, and 1 m along x, y and z, each overestimated by 10 %."""
    rows = []
    for axis, name in enumerate(['pitch', 'yaw', 'roll', 't_x', 't_y', 't_z']):
        amounts = (3.0 if axis < 3 else 1.0) * numpy.eye(6)[axis]
        rows += features.rows(name, motion(amounts), motion(1.1 * amounts))
    write_table(path, COLUMNS, rows)


def write_fig5(features, path):
    """A turn of 50 deg/s with 10 deg/s of pitch and 5 deg/s of roll at 50 km/h, seen at 10 Hz. The assumed rotation
    is right, the assumed translation 5 % too long; five features have too small a depth."""
    rotation, translation = motion(0.1 * numpy.array([10.0, 50.0, 5.0, 0.0, 0.0, 50.0 / 3.6]))
    factors = numpy.ones(len(features.points_m))
    factors[numpy.arange(1, WRONG_DEPTHS + 1) * len(factors) // (WRONG_DEPTHS + 1)] = 0.95
    write_table(path, COLUMNS, features.rows('turn', (rotation, translation), (rotation, 1.05 * translation), factors))
