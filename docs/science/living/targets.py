"""Targets of the fit of docs/science/living-embryo.md: value and width of each measure of a slice, and of an embryo."""

TARGETS = {
    "furrow_depth_um": (50, 6),  # embryos are deeper: by 10 um as expected, by 4 um as found
    "knee_depth_um": (6, 1.5),
    "knee_time_s": (534, 60),
    "lips_closed_time_s": (1080, 90),
    "vml_height_um": (55, 4),
    "flank_section_area_ratio": (0.94, 0.015),
    "inner5.area_ratio": (0.8, 0.1),
    "inner9.area_ratio": (0.5, 0.12),
    "outer9.area_ratio": (1.3, 0.2),
}

OF_EMBRYO = {**TARGETS, "furrow_depth_um": (60, 6)}


def score(table, targets):
    """Misfit of each row: sum of squared deviations of its measures from the targets, in units of their widths."""
    return sum(((table[measure] - value) / width) ** 2 for measure, (value, width) in targets.items())
