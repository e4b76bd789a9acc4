"""plica in napari: cells of a layer of labels, their folds, results as layers with time."""
from .layers import cells_layer, frames_layer, labels_layer

__all__ = ["cells_layer", "frames_layer", "labels_layer"]
