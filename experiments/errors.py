"""Errors of trajectories and of single motions, and whether covariances have their size.

Poses are n x 3 x 4, from the camera to the frame of the first pose [m]; errors of motions are n x 6: translation [m]
and rotation vector [rad] in the camera at the previous pair, with covariances n x 6 x 6, as in OdometryResult.
"""
import numpy

from rotrocc_tools.tables import path_lengths

BOUND_99 = 16.81  # of chi squared with 6 degrees of freedom
REST_M = 1e-6  # shorter true steps count as standstill
ANTENNA_PRIOR = numpy.diag([0.1, 1e4, 0.1])  # a car cannot show how high above the camera the antenna is
AXES = ['x', 'y', 'z', 'rx', 'ry', 'rz']


# Of trajectories.

def step_errors_percent(estimate, truth, pairs, least_m):
    """The errors of the length of the way over each window of `pairs` pairs in which `least_m` is traveled.

    A disparity bias makes all steps too long or too short; that of a rig that flexes scatters them. Single steps of
    a reference have the jitter of its stamps.
    """
    lengths = [path_lengths(positions) for positions in (estimate, truth)]
    estimated_m, true_m = [length[pairs:] - length[:-pairs] for length in lengths]
    moves = true_m >= least_m
    return 100.0 * (estimated_m[moves] / true_m[moves] - 1.0)


def position_error_percent(poses, positions):
    """RMSE of the positions of an antenna (n x 3), after the best rigid alignment and for the best place of the
    antenna on the vehicle, relative to the distance traveled."""
    antenna = numpy.zeros(3)
    centered = positions - positions.mean(axis=0)
    for _ in range(50):
        estimated = poses[:, :, 3] + poses[:, :, :3] @ antenna
        u, _, v = numpy.linalg.svd(centered.T @ (estimated - estimated.mean(axis=0)))
        rotation = u @ numpy.diag([1, 1, numpy.linalg.det(u @ v)]) @ v
        aligned = centered @ rotation + estimated.mean(axis=0)
        beside = numpy.einsum('nji,nj->i', poses[:, :, :3], aligned - poses[:, :, 3])
        antenna = numpy.linalg.solve(len(poses) * numpy.eye(3) + ANTENNA_PRIOR, beside)
    rmse_m = numpy.sqrt(numpy.mean(numpy.sum((aligned - estimated) ** 2, axis=1)))
    return 100.0 * rmse_m / path_lengths(positions)[-1]


def drift_at_rest_mm(poses, truth):
    """The largest distance from the first pose of the longest standstill; nan if it never stands still."""
    best = stop = (0, 0)
    for i, step in enumerate(numpy.linalg.norm(numpy.diff(truth[:, :, 3], axis=0), axis=1)):
        stop = (stop[0], i + 1) if step < REST_M else (i + 1, i + 1)
        best = max(best, stop, key=lambda pairs: pairs[1] - pairs[0])
    if best[0] == best[1]:
        return numpy.nan
    resting = poses[best[0]:best[1] + 1, :, 3]
    return 1e3 * numpy.linalg.norm(resting - resting[0], axis=1).max()


def largest_rotation_deg(truth):
    """Of the rotations from pair to pair."""
    rotations = truth[:-1, :, :3].transpose(0, 2, 1) @ truth[1:, :, :3]
    cosines = (numpy.trace(rotations, axis1=1, axis2=2) - 1.0) / 2.0
    return numpy.degrees(numpy.arccos(numpy.clip(cosines, -1.0, 1.0))).max()


# Of motions.

def rotation_of(vector):
    """Rotation matrix of a rotation vector [rad]."""
    angle = numpy.linalg.norm(vector)
    if angle == 0.0:
        return numpy.eye(3)
    x, y, z = vector / angle
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + numpy.sin(angle) * cross + (1 - numpy.cos(angle)) * cross @ cross


def vector_of(rotation):
    """Rotation vector of a rotation matrix, for less than half a turn."""
    axis = 0.5 * numpy.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                              rotation[1, 0] - rotation[0, 1]])
    sine = numpy.linalg.norm(axis)
    angle = numpy.arctan2(sine, 0.5 * (numpy.trace(rotation) - 1.0))
    return axis * (angle / sine if sine > 0.0 else 1.0)


def motion_errors(truth, pairs):
    """Errors and covariances of the motions in `pairs`, the rows of offline_odometry --stats. A motion is relative
    to the pair that was dt_s earlier."""
    times = numpy.array([1e-9 * int(pair['stamp_ns']) for pair in pairs])
    errors, covariances = [], []
    for index, pair in enumerate(pairs):
        if pair['state'] in ('ok', 'degraded'):
            previous = numpy.argmin(numpy.abs(times - times[index] + float(pair['dt_s'])))
            before, after = truth[previous], truth[index]
            estimate = [float(pair[name]) for name in ('x_m', 'y_m', 'z_m', 'rx_rad', 'ry_rad', 'rz_rad')]
            translation = before[:, :3].T @ (after[:, 3] - before[:, 3])
            rotation = before[:, :3].T @ after[:, :3] @ rotation_of(numpy.array(estimate[3:])).T
            errors.append([*(translation - estimate[:3]), *vector_of(rotation)])
            covariances.append([[float(pair['covariance_%s_%s' % (AXES[min(i, j)], AXES[max(i, j)])])
                                 for j in range(6)] for i in range(6)])
    return numpy.reshape(errors, (-1, 6)), numpy.reshape(covariances, (-1, 6, 6))


def normalized(errors, covariances, part=slice(0, 6)):
    """Squared errors normalized by their covariances (NEES), for a slice of the axes."""
    return numpy.einsum('ni,ni->n', errors[:, part], numpy.linalg.solve(
        covariances[:, part, part], errors[:, part, None])[:, :, 0])
