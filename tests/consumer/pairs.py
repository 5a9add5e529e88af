import ctypes
import sys
import numpy as np

fastccd = ctypes.CDLL(sys.argv[1] if len(sys.argv) > 1 else "libfastccd.so.0.1")
pairs = np.random.default_rng(1).random((1000000, 8, 3))  # points x0 to x3 at t = 0, then at t = 1
toi = np.empty(len(pairs))
vertex_face = 0
error = fastccd.fastccd_pairs_time_of_impact(vertex_face, pairs.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(len(pairs)),
                                             None, toi.ctypes.data_as(ctypes.c_void_p), None, None)
print(error, "is no error;", np.isfinite(toi).sum(), "contacts, the first at", toi.min())
