"""Frames of a run, appended to one file as steps are solved: positions and values of all fields."""
from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .shapes import NODE_FIELDS, Floats

HEAD = struct.Struct("<dIII")  # time in s, number of the shape, nodes, cells
MOST_BYTES = 2 * 10**9


class Frame(NamedTuple):
    """Place of a frame in its file."""

    time_s: float
    shape: int
    nodes: int
    cells: int
    offset: int


class FrameFile:
    """File of frames. A reader may use it while another thread appends.

    It begins with a list of the fields by cell: the length of its JSON text, and this text."""

    def __init__(self, path: Path) -> None:
        self.path, self.frames = path, list[Frame]()
        self.cell_fields: list[str] = []
        self.ends: dict[str, tuple[float, float]] = {}  # least and greatest value of each field
        if path.exists():
            self._read_index()

    def _read_index(self) -> None:
        with self.path.open("rb") as file:
            size = file.seek(0, 2)
            file.seek(0)
            offset = 4 + int.from_bytes(file.read(4), "little")
            if offset > size:
                return
            try:
                self.cell_fields = json.loads(file.read(offset - 4))
            except ValueError:
                return  # of an earlier version
            while offset + HEAD.size <= size:
                file.seek(offset)
                time_s, shape, nodes, cells = HEAD.unpack(file.read(HEAD.size))
                frame = Frame(time_s, shape, nodes, cells, offset + HEAD.size)
                if self._end(frame) > size:
                    break  # half written when the server was killed
                self.frames.append(frame)
                offset = self._end(frame)
        for index in range(len(self.frames)):
            for name in (*NODE_FIELDS, *self.cell_fields):
                self._take_ends(name, self.values(index, name))

    def _end(self, frame: Frame) -> int:
        return frame.offset + 4 * ((3 + len(NODE_FIELDS)) * frame.nodes + len(self.cell_fields) * frame.cells)

    def _take_ends(self, name: str, values: Floats) -> None:
        low, high = self.ends.get(name, (np.inf, -np.inf))
        self.ends[name] = (min(low, float(values.min())), max(high, float(values.max())))

    @property
    def is_full(self) -> bool:
        return bool(self.frames) and self.frames[-1].offset > MOST_BYTES

    def forget_after(self, time_s: float) -> None:
        """Drop the frames of steps that a resumed run takes again."""
        while self.frames and self.frames[-1].time_s > time_s:
            self.frames.pop()
        if self.path.exists():
            with self.path.open("r+b") as file:
                file.truncate(self._end(self.frames[-1]) if self.frames else 0)

    def add(self, time_s: float, shape: int, positions: Floats, values: Mapping[str, Floats]) -> None:
        if not self.frames:
            self.cell_fields = [name for name in values if name not in NODE_FIELDS]
            text = json.dumps(self.cell_fields).encode()
            self.path.write_bytes(len(text).to_bytes(4, "little") + text)
        fields = [values[name] for name in (*NODE_FIELDS, *self.cell_fields)]
        head = HEAD.pack(time_s, shape, len(positions), len(fields[-1]))
        with self.path.open("ab") as file:
            offset = file.tell() + HEAD.size
            file.write(b"".join([head, positions.tobytes(), *(field.tobytes() for field in fields)]))
        for name, field in values.items():
            self._take_ends(name, field)
        self.frames.append(Frame(time_s, shape, len(positions), len(fields[-1]), offset))

    def _numbers(self, offset: int, count: int) -> Floats:
        return np.fromfile(self.path, dtype="f4", count=count, offset=offset)

    def positions(self, index: int) -> Floats:
        frame = self.frames[index]
        return self._numbers(frame.offset, 3 * frame.nodes)

    def values(self, index: int, name: str) -> Floats:
        frame = self.frames[index]
        if name in NODE_FIELDS:
            return self._numbers(frame.offset + 4 * (3 + NODE_FIELDS.index(name)) * frame.nodes, frame.nodes)
        place = (3 + len(NODE_FIELDS)) * frame.nodes + self.cell_fields.index(name) * frame.cells
        return self._numbers(frame.offset + 4 * place, frame.cells)
