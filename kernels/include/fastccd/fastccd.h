/* fastccd for C, and for what calls C: Python's ctypes, Julia, Rust, C#. Plain arrays and structs; C99.
 *
 * Everything means what it means in <fastccd/fastccd.hpp>: nothing missed, never late, the same bits on every instruction
 * set and thread count. Arrays are contiguous, in C order ("rows" below), and belong to the caller; nothing is kept
 * after a call. All functions may be called from any number of threads at once, and print nothing.
 *
 * Every function that can fail returns an error, FASTCCD_OK if there is none; fastccd_message() says it in words. On an
 * error outputs are as they were before, except where a function says otherwise. Pointers marked "or NULL" may be NULL; so may
 * arrays without elements.
 *
 * Structs that may grow begin with `size`, sizeof of the struct as the caller knows it. Later versions only append fields; those
 * that the caller does not know have their defaults, so that programs and libraries of different age understand each other. The
 * others, fastccd_contact and fastccd_fault, stay as they are.
 */
#ifndef FASTCCD_H
#define FASTCCD_H

#include <stddef.h>
#include <stdint.h>

#include <fastccd/export.h>
#include <fastccd/version.h>

#ifdef __cplusplus
extern "C" {
#endif

enum fastccd_error {
    FASTCCD_OK = 0,
    FASTCCD_BAD_TOLERANCE = 1,       /* tolerance is not a positive finite number */
    FASTCCD_BAD_T_MAX = 2,           /* t_max is not in (0, 1] */
    FASTCCD_WRONG_SIZE = 3,          /* an array is NULL but should not be empty, or larger than memory can be */
    FASTCCD_EXACT_UNAVAILABLE = 4,   /* `exact` in a build without GMP */
    FASTCCD_ISA_UNAVAILABLE = 5,     /* the instruction set is not in this build or not on this machine */
    FASTCCD_BAD_ISA_ENVIRONMENT = 6, /* FASTCCD_ISA names no instruction set, or one that is unavailable */
    FASTCCD_INDEX_OUT_OF_RANGE = 7,  /* of a pair; see fastccd_fault */
    FASTCCD_INVALID_PAIR = 8,        /* a NaN or an infinity in a pair, in a call that cannot leave it out; see fastccd_fault */
    FASTCCD_OUT_OF_MEMORY = 9,       /* or the system refused a thread; what `toi` and `roots` hold is unspecified */
    FASTCCD_BAD_MINIMUM_SEPARATION = 10, /* minimum_separation is negative, infinite or not a number */
    FASTCCD_BAD_DISTANCE_TOLERANCE = 11, /* distance_tolerance is negative, infinite or not a number */
    FASTCCD_EXACT_SEPARATION = 12,       /* `exact` together with a minimum separation */
    FASTCCD_BAD_FACE_INDEX = 13,     /* a face of the mesh refers to a vertex that is not there; see fastccd_fault */
    FASTCCD_BAD_EDGE_INDEX = 14,     /* an edge of the mesh does */
    FASTCCD_BAD_ARGUMENT = 100       /* a NULL that is not allowed, an unknown kind, threads < 0, a struct whose size is not set, a reserved
                                        option that is not 0, or a field of a later version that is not 0 */
};

enum fastccd_kind {
    FASTCCD_VERTEX_FACE = 0, /* points x0 | x1 x2 x3; indices: vertex, face */
    FASTCCD_EDGE_EDGE = 1    /* points x0 x1 | x2 x3; indices: edge, edge */
};

enum fastccd_isa {
    FASTCCD_ISA_AUTOMATIC = 0, /* the widest available; honours the environment variable FASTCCD_ISA */
    FASTCCD_ISA_SCALAR = 1,
    FASTCCD_ISA_SSE2 = 2,
    FASTCCD_ISA_AVX2 = 3,
    FASTCCD_ISA_AVX512 = 4,
    FASTCCD_ISA_NEON = 5
};

/* Fill it with fastccd_options_init(), then change what you want. NULL in place of it: the defaults. */
typedef struct fastccd_options {
    size_t size;
    double tolerance;  /* E_tol, in units of the step: 1e-9 */
    double t_max;      /* contact is searched in [0, t_max], 0 < t_max <= 1: 1 */
    int32_t isa;       /* enum fastccd_isa: automatic */
    int32_t reference; /* not 0: the certified search alone, slower, the same bits */
    int32_t exact;     /* not 0: settle possible contacts by rational arithmetic */
    int32_t reserved;  /* 0 */
    double minimum_separation; /* d > 0: contact is a distance of at most d: 0 */
    double distance_tolerance; /* then: at most (1 + distance_tolerance) d counts as contact: 1e-6 */
    int32_t threads;   /* at most so many work for a call, the caller's included; 0: no limit */
    int32_t reserved2; /* 0 */
} fastccd_options;

/* A mesh that moves linearly over the step. */
typedef struct fastccd_mesh {
    size_t size;
    size_t vertex_count;
    const double* start; /* vertex_count x 3: positions at t = 0, */
    const double* end;   /* and at t = 1 */
    size_t face_count;
    const int32_t* faces; /* face_count x 3: indices of vertices */
    size_t edge_count;
    const int32_t* edges; /* edge_count x 2 */
} fastccd_mesh;

/* One contact of a compact result. */
typedef struct fastccd_contact {
    size_t pair;    /* index of the pair in the input */
    double toi;     /* lower bound of its first time of contact */
    int32_t proven; /* 1: there is contact, certainly; 0: contact is not excluded, to within rounding,
                       distance_tolerance or a cap on the work */
    int32_t at_start; /* 1: with a minimum separation: not certainly farther apart than that at t = 0
                         (or before t = 2^-1071) */
} fastccd_contact;

/* Set `size` before the call. */
typedef struct fastccd_summary {
    size_t size;
    size_t pairs, contacts, proven, odd, even, invalid, scalar_pairs;
    size_t earliest_pair; /* SIZE_MAX: none */
    double earliest_toi;  /* INFINITY: none */
    int32_t isa;          /* kernels that ran */
    int32_t reserved;
    size_t at_start;      /* contacts with at_start, see fastccd_contact */
} fastccd_summary;

/* Set `size` before the call. */
typedef struct fastccd_step {
    size_t size;
    double step;  /* nothing touches in [0, step); t_max if there is no contact; 0 on every error but an unset `size` */
    size_t pair;  /* the pair that limits the step; SIZE_MAX: none */
    int32_t kind; /* enum fastccd_kind: which candidates `pair`, here or in the fault of a pair, counts */
    int32_t reserved;
} fastccd_step;

/* What is at fault. Written on FASTCCD_INDEX_OUT_OF_RANGE and FASTCCD_INVALID_PAIR (`index` is 0 then), FASTCCD_BAD_FACE_INDEX and
 * FASTCCD_BAD_EDGE_INDEX; otherwise left as it was. */
typedef struct fastccd_fault {
    size_t pair;   /* the pair; on the last two, the row of `faces` or `edges` */
    int64_t index; /* the index it holds */
} fastccd_fault;

/* Version of the library that runs, such as "0.1.0"; that of the headers is FASTCCD_VERSION. */
FASTCCD_API const char* fastccd_version(void);
/* A sentence about an error; static storage. */
FASTCCD_API const char* fastccd_message(int error);

/* Lower-case name, "unknown" for a number that is no instruction set; static storage. */
FASTCCD_API const char* fastccd_isa_name(int isa);
/* Pairs per batch; 0 for automatic and unknown. */
FASTCCD_API int fastccd_isa_lanes(int isa);
/* 1 if it is part of this build and supported by this machine. */
FASTCCD_API int fastccd_isa_available(int isa);
/* The widest available. */
FASTCCD_API int fastccd_best_isa(void);

/* The defaults. `size`: sizeof(fastccd_options). */
FASTCCD_API void fastccd_options_init(fastccd_options* options, size_t size);

/* One pair: four points at t = 0 and at t = 1, x y z each. *toi: lower bound of the first time of contact in [0, t_max];
 * INFINITY: certainly apart; NAN: a coordinate is NaN or infinite, or there is an error. The certified search in the caller's thread,
 * whatever the instruction set; no allocation unless `exact`. `options`: or NULL. */
FASTCCD_API int fastccd_vertex_face_toi(const double x0[12], const double x1[12], const fastccd_options* options, double* toi);
FASTCCD_API int fastccd_edge_edge_toi(const double x0[12], const double x1[12], const fastccd_options* options, double* toi);

/* Packed pairs: `pairs` is count x 8 x 3, the points x0..x3 at t = 0, then at t = 1.
 * toi: count values as above. roots, or NULL: count numbers of contact roots (odd: through, or at an end of the step; even: grazing, or in and out
 * again; 0: none, or not countable). `options`, `summary`: or NULL. O(count). */
FASTCCD_API int fastccd_pairs_time_of_impact(int kind, const double* pairs, size_t count, const fastccd_options* options,
                                             double* toi, uint8_t* roots, fastccd_summary* summary);
/* The pairs in contact, in pair order: the first `capacity` of them into `contacts`, their number into *found (which may
 * be more). `contacts` may be NULL if capacity is 0; all are collected within the call then, too.
 * Pairs with a NaN or an infinity are no contacts but counted in summary->invalid; fastccd_pairs_time_of_impact() tells which they are. */
FASTCCD_API int fastccd_pairs_find_contacts(int kind, const double* pairs, size_t count, const fastccd_options* options,
                                            fastccd_contact* contacts, size_t capacity, size_t* found, fastccd_summary* summary);
/* The first contact of all: smallest toi, ties to the smaller index; pair SIZE_MAX and toi INFINITY if no pair touches. Faster than
 * looking for it in all of them, as pairs that cannot be the first are dropped early. So pairs with a NaN or an infinity are counted
 * in summary->invalid only as far as they were looked at, and contacts are not counted. */
FASTCCD_API int fastccd_pairs_earliest_contact(int kind, const double* pairs, size_t count, const fastccd_options* options,
                                               fastccd_contact* contact, fastccd_summary* summary);
/* The largest step that all candidates together allow: the smallest toi, ties to vertex-face, then to the smaller index.
 * A pair with a NaN or an infinity allows none: FASTCCD_INVALID_PAIR. Leave out pairs that share a vertex: they touch at time 0.
 * `fault`: or NULL. */
FASTCCD_API int fastccd_pairs_collision_free_step(const double* vertex_face, size_t vertex_face_count, const double* edge_edge,
                                                  size_t edge_edge_count, const fastccd_options* options, fastccd_step* step,
                                                  fastccd_fault* fault);

/* Pairs of a mesh: `pairs` is count x 2 indices. Indices, those of faces and edges too, are checked before any work. Each call copies
 * the positions, 64 bytes a vertex, and, if there are two pairs or more for every vertex and primitive of that kind, makes their boxes,
 * 32 bytes each: better one call with all pairs of a kind than many with some. `fault`: or NULL. */
FASTCCD_API int fastccd_mesh_time_of_impact(const fastccd_mesh* mesh, int kind, const int32_t* pairs, size_t count,
                                            const fastccd_options* options, double* toi, uint8_t* roots,
                                            fastccd_summary* summary, fastccd_fault* fault);
FASTCCD_API int fastccd_mesh_find_contacts(const fastccd_mesh* mesh, int kind, const int32_t* pairs, size_t count,
                                           const fastccd_options* options, fastccd_contact* contacts, size_t capacity,
                                           size_t* found, fastccd_summary* summary, fastccd_fault* fault);
FASTCCD_API int fastccd_mesh_earliest_contact(const fastccd_mesh* mesh, int kind, const int32_t* pairs, size_t count,
                                              const fastccd_options* options, fastccd_contact* contact, fastccd_summary* summary,
                                              fastccd_fault* fault);
FASTCCD_API int fastccd_mesh_collision_free_step(const fastccd_mesh* mesh, const int32_t* vertex_face, size_t vertex_face_count,
                                                 const int32_t* edge_edge, size_t edge_edge_count,
                                                 const fastccd_options* options, fastccd_step* step, fastccd_fault* fault);

#ifdef __cplusplus
}
#endif

#endif
