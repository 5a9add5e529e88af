"""The C interface from Python's ctypes, on memory of numpy. Argument: the shared library."""
import ctypes
import os
import sys
from ctypes import POINTER, Structure, byref, c_double, c_int, c_int32, c_int64, c_size_t, c_void_p, sizeof

import numpy as np


class Options(Structure):
    _fields_ = [("size", c_size_t), ("tolerance", c_double), ("t_max", c_double), ("isa", c_int32),
                ("reference", c_int32), ("exact", c_int32), ("reserved", c_int32),
                ("minimum_separation", c_double), ("distance_tolerance", c_double), ("threads", c_int32), ("reserved2", c_int32)]


class Mesh(Structure):
    _fields_ = [("size", c_size_t), ("vertex_count", c_size_t), ("start", c_void_p), ("end", c_void_p),
                ("face_count", c_size_t), ("faces", c_void_p), ("edge_count", c_size_t), ("edges", c_void_p)]


class Step(Structure):
    _fields_ = [("size", c_size_t), ("step", c_double), ("pair", c_size_t), ("kind", c_int32), ("reserved", c_int32)]


class Fault(Structure):
    _fields_ = [("pair", c_size_t), ("index", c_int64)]


contact = np.dtype([("pair", np.uintp), ("toi", np.float64), ("proven", np.int32), ("at_start", np.int32)])
VERTEX_FACE, EDGE_EDGE = 0, 1
INDEX_OUT_OF_RANGE = 7

library = ctypes.CDLL(sys.argv[1])
library.fastccd_version.restype = library.fastccd_message.restype = ctypes.c_char_p
library.fastccd_options_init.argtypes = [POINTER(Options), c_size_t]
library.fastccd_options_init.restype = None
library.fastccd_pairs_time_of_impact.argtypes = [c_int, c_void_p, c_size_t, c_void_p, c_void_p, c_void_p, c_void_p]
library.fastccd_pairs_earliest_contact.argtypes = [c_int, c_void_p, c_size_t, c_void_p, c_void_p, c_void_p]
library.fastccd_mesh_find_contacts.argtypes = [POINTER(Mesh), c_int, c_void_p, c_size_t, c_void_p, c_void_p, c_size_t,
                                               POINTER(c_size_t), c_void_p, c_void_p]
library.fastccd_mesh_collision_free_step.argtypes = [POINTER(Mesh), c_void_p, c_size_t, c_void_p, c_size_t, c_void_p,
                                                     POINTER(Step), c_void_p]


def check(error):
    if error:
        raise RuntimeError(library.fastccd_message(error).decode())


print("fastccd", library.fastccd_version().decode())

# Packed pairs (n, 8, 3): vertices that fall from height h at speed 2 onto a large face touch at h / 2.
n = 1000
height = np.linspace(0.1, 3.0, n)
pairs = np.zeros((n, 8, 3))
pairs[:, 0, 2] = height
pairs[:, 4, 2] = height - 2
pairs[:, 1:4] = pairs[:, 5:8] = [[-1, -1, 0], [1, -1, 0], [0, 1, 0]]
toi = np.empty(n)
roots = np.empty(n, np.uint8)
options = Options()
library.fastccd_options_init(byref(options), sizeof(options))
options.tolerance = 1e-6
check(library.fastccd_pairs_time_of_impact(VERTEX_FACE, pairs.ctypes.data, n, byref(options), toi.ctypes.data, roots.ctypes.data, None))
hit = height < 2
assert (toi[hit] <= height[hit] / 2).all() and (toi[hit] >= height[hit] / 2 - 1e-6).all()
assert np.isinf(toi[~hit]).all()
assert (roots[hit] == 1).all() and (roots[~hit] == 0).all()

# The first contact; its first pair is the lowest vertex. With `threads`, a process may be kept from having more than it wants.
first = np.empty(1, contact)
check(library.fastccd_pairs_earliest_contact(VERTEX_FACE, pairs.ctypes.data, n, byref(options), first.ctypes.data, None))
assert first["pair"] == 0 and first["toi"] == toi.min() and first["proven"] == 1

# The same as a mesh (V, 3) with faces (F, 3), and candidates (n, 2).
start, end = (np.ascontiguousarray(np.vstack([pairs[:, 4 * t], pairs[0, 4 * t + 1:4 * t + 4]])) for t in (0, 1))
faces = np.array([[n, n + 1, n + 2]], np.int32)
candidates = np.stack([np.arange(n), np.zeros(n)], axis=1).astype(np.int32)
mesh = Mesh(sizeof(Mesh), len(start), start.ctypes.data, end.ctypes.data, len(faces), faces.ctypes.data, 0, None)
contacts = np.empty(n, contact)
found = c_size_t()
check(library.fastccd_mesh_find_contacts(byref(mesh), VERTEX_FACE, candidates.ctypes.data, n, byref(options),
                                         contacts.ctypes.data, n, byref(found), None, None))
contacts = contacts[:found.value]
assert (contacts["pair"] == np.flatnonzero(hit)).all()
assert (contacts["toi"] == toi[hit]).all() and contacts["proven"].all()

step = Step(size=sizeof(Step))
check(library.fastccd_mesh_collision_free_step(byref(mesh), candidates.ctypes.data, n, None, 0, byref(options), byref(step), None))
assert step.step == toi.min() and step.pair == 0 and step.kind == VERTEX_FACE
candidates[17, 0] = n + 3
fault = Fault()
error = library.fastccd_mesh_collision_free_step(byref(mesh), candidates.ctypes.data, n, None, 0, None, byref(step), byref(fault))
assert error == INDEX_OUT_OF_RANGE and fault.pair == 17 and fault.index == n + 3 and step.step == 0
print(found.value, "contacts of", n, "pairs, as computed by hand")
