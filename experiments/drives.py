"""Drives in KITTI layout: parts of them, and their ground truth."""
import shutil

import numpy
from PIL import Image


def take_pairs(sequence, taken, target):
    """A folder with some pairs of a sequence, by their numbers; images are links."""
    shutil.rmtree(str(target), ignore_errors=True)
    for side in ('image_0', 'image_1'):
        (target / side).mkdir(parents=True)
        images = sorted((sequence / side).iterdir())
        for index, image in enumerate(images[pair] for pair in taken):
            (target / side / ('%06d%s' % (index, image.suffix))).symlink_to(image.resolve())
    (target / 'calib.txt').write_text((sequence / 'calib.txt').read_text())
    for name in ('times.txt', 'poses.txt', 'ins.txt'):
        if (sequence / name).is_file():
            lines = (sequence / name).read_text().splitlines(True)
            (target / name).write_text(''.join(lines[pair] for pair in taken))
    return target


def count_pairs(sequence):
    return len((sequence / 'times.txt').read_text().splitlines())


def take_every(sequence, every, target):
    """A folder with each `every`-th pair of a sequence."""
    return take_pairs(sequence, range(0, count_pairs(sequence), every), target)


def change_images(sequence, target, change):
    """A folder with a sequence whose images are change(pair, is_right, gray), of gray levels (n x m)."""
    take_pairs(sequence, range(count_pairs(sequence)), target)
    for is_right, side in enumerate(('image_0', 'image_1')):
        for pair, path in enumerate(sorted((target / side).iterdir())):
            gray = numpy.rint(change(pair, is_right, numpy.asarray(Image.open(str(path)), dtype=float)))
            path.unlink()  # the link
            Image.fromarray(gray.clip(0, 255).astype(numpy.uint8)).save(str(path), compress_level=1)
    return target


def resize(sequence, target, factor, noise):
    """A folder with a sequence of `factor` times the size, its calibration as well, and fresh noise [gray levels]."""
    random = numpy.random.RandomState(0)

    def resized(pair, is_right, gray):
        size = [round(factor * side) for side in reversed(gray.shape)]
        image = Image.fromarray(gray.astype(numpy.uint8)).resize(size, Image.BICUBIC)
        return numpy.asarray(image, dtype=float) + noise * random.normal(size=(size[1], size[0]))
    change_images(sequence, target, resized)
    before, after = [Image.open(str(sorted((folder / 'image_0').iterdir())[0])).size for folder in (sequence, target)]
    scale = [to / size for size, to in zip(before, after)]
    lines = [line.split() for line in (target / 'calib.txt').read_text().splitlines()]
    for words in [words for words in lines if words and words[0].startswith('P')]:
        projection = numpy.array(words[1:], dtype=float).reshape(3, 4)
        for row, factor_of_row in enumerate(scale):  # the corner of the image stays, not the middle of its first pixel
            projection[row] *= factor_of_row
            projection[row, 2] += 0.5 * (factor_of_row - 1)
        words[1:] = ['%.12g' % value for value in projection.ravel()]
    (target / 'calib.txt').write_text(''.join(' '.join(words) + '\n' for words in lines))
    return target


def read_poses(path):
    """n x 3 x 4."""
    return numpy.loadtxt(str(path), ndmin=2).reshape(-1, 3, 4)


def read_truth(sequence):
    """The true poses, or None, and the true positions (n x 3) [m], or None."""
    if (sequence / 'poses.txt').is_file():
        poses = read_poses(sequence / 'poses.txt')
        return poses, poses[:, :, 3]
    if (sequence / 'ins.txt').is_file():
        return None, numpy.loadtxt(str(sequence / 'ins.txt'), ndmin=2, usecols=[4, 5, 6])
    return None, None
