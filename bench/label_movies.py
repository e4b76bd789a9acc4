"""Movies of labels for benchmarks: cells followed by their centroids, and labels made wrong."""
import numpy as np
from scipy.optimize import linear_sum_assignment
from skimage.measure import regionprops


def tracked(frames, most, spacing=1.0):
    """Return rows of time, label, and label in the first frame: nearest centroids, one to one, at most a distance apart; `frames`:
    labels by time, `spacing`: of their pixels or voxels."""
    of_frame = {}
    for time, labels in frames.items():
        regions = regionprops(labels)
        of_frame[time] = np.array([region.centroid for region in regions]) * spacing, [region.label for region in regions]
    (start, (centres, first)), *later = of_frame.items()
    place = centres.copy()
    rows = [(start, one, one) for one in first]
    for time, (centres, names) in later:
        apart = np.linalg.norm(place[:, None] - centres[None], axis=2)
        for track, found in zip(*linear_sum_assignment(np.minimum(apart, 2 * most))):
            if apart[track, found] < most:
                rows.append((time, names[found], first[track]))
                place[track] = centres[found]
    return np.array(rows)


def damage(labels, regions, wrong, rng, spacing=1.0):
    """Make a part of these regions wrong in place: every other one merged with its nearest, the others cut in two along the height."""
    centres = np.array([region.centroid for region in regions]) * spacing
    for turn, chosen in enumerate(rng.choice(len(regions), round(wrong * len(regions)), replace=False)):
        region = regions[chosen]
        if turn % 2:
            nearest = np.argsort(np.linalg.norm(centres - centres[chosen], axis=1))[1]
            labels[labels == region.label] = regions[nearest].label
        else:
            angle = rng.uniform(0, np.pi)
            across = [*[0] * (labels.ndim - 2), np.cos(angle), np.sin(angle)]
            beyond = (region.coords - region.centroid) * spacing @ across > 0
            labels[tuple(region.coords[beyond].T)] = labels.max() + 1
