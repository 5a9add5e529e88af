/* The C interface, compiled as C99: answers, errors, threads, and structs of other sizes than this version's. */
#define _GNU_SOURCE /* sched_getaffinity */
#include <fastccd/fastccd.h>

#include <dirent.h>
#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;
#define EXPECT(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
            ++failures; \
        } \
    } while (0)

/* A vertex falls onto a face for half of the step; an edge of that face is met by another edge after a quarter. */
static const double start[] = {0, 0, 1, -1, -1, 0, 1, -1, 0, 0, 1, 0, -2, -1, 0.5, 2, -1, 0.5};
static const double end[] = {0, 0, -1, -1, -1, 0, 1, -1, 0, 0, 1, 0, -2, -1, -1.5, 2, -1, -1.5};
static const int32_t faces[] = {1, 2, 3};
static const int32_t edges[] = {2, 3, 4, 5};
static const int32_t vertex_face[] = {0, 0};
static const int32_t edge_edge[] = {0, 1};

static int near(double toi, double time) { return toi <= time && toi >= time - 1e-9; }

static fastccd_mesh make_mesh(void)
{
    fastccd_mesh mesh;
    mesh.size = sizeof mesh;
    mesh.vertex_count = 6;
    mesh.start = start;
    mesh.end = end;
    mesh.face_count = 1;
    mesh.faces = faces;
    mesh.edge_count = 2;
    mesh.edges = edges;
    return mesh;
}

static int count_threads(void)
{
    int count = 0;
    struct dirent* entry;
    DIR* const threads = opendir("/proc/self/task");
    if (threads == NULL) return -1;
    while ((entry = readdir(threads)) != NULL) count += entry->d_name[0] != '.';
    closedir(threads);
    return count;
}

/* With one thread asked for, no other is started; otherwise, as this would notice, there are more. To be called first. */
static void test_threads(void)
{
    enum { many = 1 << 16 };
    double* const pairs = calloc(many, 24 * sizeof(double));
    double* const toi = malloc(many * sizeof(double));
    int32_t* const candidates = calloc(many, 2 * sizeof(int32_t)); /* vertex 0 and face 0, always */
    const fastccd_mesh mesh = make_mesh();
    fastccd_options options;
    fastccd_step step;
    fastccd_contact first;
    size_t found = 0;
    cpu_set_t processors;
    const int several = sched_getaffinity(0, sizeof processors, &processors) == 0 && CPU_COUNT(&processors) > 1;
    const int before = count_threads(); /* an emulator has some of its own */
    int i, tries = 0;
    EXPECT(pairs != NULL && toi != NULL && candidates != NULL);
    step.size = sizeof step;
    if (failures > 0) return;
    for (i = 0; i < many; ++i) {
        memcpy(pairs + 24 * i, start, 12 * sizeof(double));
        memcpy(pairs + 24 * i + 12, end, 12 * sizeof(double));
    }
    fastccd_options_init(&options, sizeof options);
    options.threads = 1;
    EXPECT(fastccd_pairs_time_of_impact(FASTCCD_VERTEX_FACE, pairs, many, &options, toi, NULL, NULL) == FASTCCD_OK);
    EXPECT(near(toi[0], 0.5) && toi[many - 1] == toi[0] && count_threads() == before);
    EXPECT(fastccd_pairs_find_contacts(FASTCCD_VERTEX_FACE, pairs, many, &options, NULL, 0, &found, NULL) == FASTCCD_OK && found == many);
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, candidates, many, &options, toi, NULL, NULL, NULL) == FASTCCD_OK);
    EXPECT(fastccd_mesh_collision_free_step(&mesh, candidates, many, NULL, 0, &options, &step, NULL) == FASTCCD_OK && step.step == toi[0]);
    EXPECT(fastccd_mesh_earliest_contact(&mesh, FASTCCD_VERTEX_FACE, candidates, many, &options, &first, NULL, NULL) == FASTCCD_OK);
    EXPECT(first.toi == toi[0] && first.pair == 0 && count_threads() == before);
    options.threads = 0;
    do {
        EXPECT(fastccd_pairs_time_of_impact(FASTCCD_VERTEX_FACE, pairs, many, &options, toi, NULL, NULL) == FASTCCD_OK);
    } while (several && count_threads() == before && ++tries < 1000);
    EXPECT(near(toi[0], 0.5) && toi[many - 1] == toi[0]);
    EXPECT(!several || count_threads() > before);
    free(pairs);
    free(toi);
    free(candidates);
}

static void test_queries(void)
{
    fastccd_options options;
    EXPECT(strcmp(fastccd_version(), FASTCCD_VERSION) == 0);
    EXPECT(strcmp(fastccd_isa_name(FASTCCD_ISA_AVX512), "avx512") == 0);
    EXPECT(strcmp(fastccd_isa_name(99), "unknown") == 0);
    EXPECT(fastccd_isa_lanes(FASTCCD_ISA_SCALAR) == 1 && fastccd_isa_lanes(-1) == 0);
    EXPECT(fastccd_isa_available(FASTCCD_ISA_SCALAR) == 1 && fastccd_isa_available(99) == 0);
    EXPECT(fastccd_isa_available(fastccd_best_isa()) == 1);
    EXPECT(strcmp(fastccd_message(FASTCCD_OK), "no error") == 0);
    EXPECT(strcmp(fastccd_message(FASTCCD_BAD_ARGUMENT), fastccd_message(FASTCCD_OUT_OF_MEMORY)) != 0);
    EXPECT(strcmp(fastccd_message(-1), "unknown error") == 0 && strcmp(fastccd_message(50), "unknown error") == 0);
    fastccd_options_init(&options, sizeof options);
    EXPECT(options.tolerance == 1e-9 && options.t_max == 1.0 && options.isa == FASTCCD_ISA_AUTOMATIC);
    EXPECT(options.reference == 0 && options.exact == 0 && options.reserved == 0 && options.threads == 0 && options.reserved2 == 0);
}

static void test_single_pairs(void)
{
    double toi = 7.0;
    double bad[12];
    fastccd_options options;
    EXPECT(fastccd_vertex_face_toi(start, end, NULL, &toi) == FASTCCD_OK && near(toi, 0.5));
    fastccd_options_init(&options, sizeof options);
    options.t_max = 0.25;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_OK && isinf(toi));
    /* Points 2 3 4 5 are the two edges. */
    EXPECT(fastccd_edge_edge_toi(start + 6, end + 6, NULL, &toi) == FASTCCD_OK && near(toi, 0.25));
    options.t_max = 0.0;
    EXPECT(fastccd_edge_edge_toi(start, end, &options, &toi) == FASTCCD_BAD_T_MAX && isnan(toi));
    fastccd_options_init(&options, sizeof options);
    options.isa = 77;
    toi = 7.0;
    EXPECT(fastccd_edge_edge_toi(start, end, &options, &toi) == FASTCCD_ISA_UNAVAILABLE && isnan(toi));
    memcpy(bad, start, sizeof bad);
    bad[4] = NAN;
    EXPECT(fastccd_vertex_face_toi(bad, end, NULL, &toi) == FASTCCD_OK && isnan(toi));
    toi = 7.0;
    EXPECT(fastccd_vertex_face_toi(NULL, end, NULL, &toi) == FASTCCD_BAD_ARGUMENT && isnan(toi));
    toi = 7.0;
    EXPECT(fastccd_edge_edge_toi(start, NULL, NULL, &toi) == FASTCCD_BAD_ARGUMENT && isnan(toi));
    EXPECT(fastccd_vertex_face_toi(start, end, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
    fastccd_options_init(&options, sizeof options);
    options.reserved = 1; /* what a later version may mean something by */
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_BAD_ARGUMENT && isnan(toi));
    options.reserved = 0;
    options.reserved2 = 1;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_BAD_ARGUMENT && isnan(toi));
    options.reserved2 = 0;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_OK);
}

static void test_packed_pairs(void)
{
    double pairs[3][24];
    double toi[3] = {7, 7, 7};
    uint8_t roots[3] = {9, 9, 9};
    fastccd_summary summary;
    fastccd_contact contacts[2];
    size_t found = 99;
    int i;
    for (i = 0; i < 3; ++i) {
        memcpy(pairs[i], start, 12 * sizeof(double));
        memcpy(pairs[i] + 12, end, 12 * sizeof(double));
    }
    pairs[1][0] += 10.0; /* far away, always */
    pairs[1][12] += 10.0;
    summary.size = sizeof summary;
    EXPECT(fastccd_pairs_time_of_impact(FASTCCD_VERTEX_FACE, pairs[0], 3, NULL, toi, roots, &summary) == FASTCCD_OK);
    EXPECT(near(toi[0], 0.5) && isinf(toi[1]) && toi[2] == toi[0]);
    EXPECT(roots[0] == 1 && roots[1] == 0 && roots[2] == 1);
    EXPECT(summary.size == sizeof summary && summary.pairs == 3 && summary.contacts == 2 && summary.proven == 2 && summary.odd == 2);
    EXPECT(summary.earliest_pair == 0 && summary.earliest_toi == toi[0] && summary.isa == fastccd_best_isa());

    EXPECT(fastccd_pairs_find_contacts(FASTCCD_VERTEX_FACE, pairs[0], 3, NULL, contacts, 2, &found, NULL) == FASTCCD_OK);
    EXPECT(found == 2 && contacts[0].pair == 0 && contacts[1].pair == 2 && contacts[1].toi == toi[0] && contacts[1].proven == 1);
    contacts[0].pair = contacts[1].pair = 77;
    EXPECT(fastccd_pairs_find_contacts(FASTCCD_VERTEX_FACE, pairs[0], 3, NULL, contacts, 1, &found, NULL) == FASTCCD_OK);
    EXPECT(found == 2 && contacts[0].pair == 0 && contacts[1].pair == 77);
    EXPECT(fastccd_pairs_find_contacts(FASTCCD_VERTEX_FACE, NULL, 0, NULL, NULL, 0, &found, NULL) == FASTCCD_OK && found == 0);

    EXPECT(fastccd_pairs_time_of_impact(2, pairs[0], 3, NULL, toi, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
    EXPECT(fastccd_pairs_time_of_impact(FASTCCD_EDGE_EDGE, NULL, 3, NULL, toi, NULL, NULL) == FASTCCD_WRONG_SIZE);
    EXPECT(fastccd_pairs_time_of_impact(FASTCCD_EDGE_EDGE, pairs[0], 3, NULL, NULL, NULL, NULL) == FASTCCD_WRONG_SIZE);
    EXPECT(fastccd_pairs_find_contacts(FASTCCD_EDGE_EDGE, pairs[0], (size_t)-1, NULL, contacts, 2, &found, NULL) == FASTCCD_WRONG_SIZE);
    EXPECT(fastccd_pairs_time_of_impact(FASTCCD_EDGE_EDGE, pairs[0], (size_t)-5, NULL, toi, roots, NULL) == FASTCCD_WRONG_SIZE);
    EXPECT(fastccd_pairs_find_contacts(FASTCCD_EDGE_EDGE, pairs[0], 3, NULL, NULL, 2, &found, NULL) == FASTCCD_BAD_ARGUMENT);
    EXPECT(fastccd_pairs_find_contacts(FASTCCD_EDGE_EDGE, pairs[0], 3, NULL, contacts, 2, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
}

static void test_first_of_packed_pairs(void)
{
    double faces_met[3][24], edges_met[1][24];
    fastccd_contact first = {77, 77, 77, 77};
    fastccd_summary summary;
    fastccd_step step;
    fastccd_fault fault = {77, 77};
    fastccd_options options;
    int i;
    for (i = 0; i < 3; ++i) {
        memcpy(faces_met[i], start, 12 * sizeof(double));
        memcpy(faces_met[i] + 12, end, 12 * sizeof(double));
    }
    faces_met[0][2] += 0.25; /* later */
    memcpy(edges_met[0], start + 6, 12 * sizeof(double));
    memcpy(edges_met[0] + 12, end + 6, 12 * sizeof(double));
    fastccd_options_init(&options, sizeof options);
    for (options.threads = 0; options.threads < 3; ++options.threads) {
        summary.size = sizeof summary;
        EXPECT(fastccd_pairs_earliest_contact(FASTCCD_VERTEX_FACE, faces_met[0], 3, &options, &first, &summary) == FASTCCD_OK);
        EXPECT(first.pair == 1 && near(first.toi, 0.5) && first.proven == 1 && first.at_start == 0);
        EXPECT(summary.pairs == 3 && summary.earliest_pair == 1 && summary.earliest_toi == first.toi);
        step.size = sizeof step;
        EXPECT(fastccd_pairs_collision_free_step(faces_met[0], 3, edges_met[0], 1, &options, &step, &fault) == FASTCCD_OK);
        EXPECT(near(step.step, 0.25) && step.kind == FASTCCD_EDGE_EDGE && step.pair == 0 && fault.pair == 77);
        EXPECT(fastccd_pairs_collision_free_step(faces_met[0], 3, NULL, 0, &options, &step, NULL) == FASTCCD_OK);
        EXPECT(step.step == first.toi && step.kind == FASTCCD_VERTEX_FACE && step.pair == 1);
    }
    options.threads = -1;
    EXPECT(fastccd_pairs_earliest_contact(FASTCCD_VERTEX_FACE, faces_met[0], 3, &options, &first, NULL) == FASTCCD_BAD_ARGUMENT);
    EXPECT(first.pair == 1);
    EXPECT(fastccd_pairs_collision_free_step(faces_met[0], 3, NULL, 0, &options, &step, NULL) == FASTCCD_BAD_ARGUMENT && step.step == 0.0);

    faces_met[2][5] = NAN; /* the first contact is among the others, but no step is certain */
    EXPECT(fastccd_pairs_earliest_contact(FASTCCD_VERTEX_FACE, faces_met[0], 3, NULL, &first, NULL) == FASTCCD_OK && first.pair == 1);
    EXPECT(fastccd_pairs_collision_free_step(faces_met[0], 3, edges_met[0], 1, NULL, &step, &fault) == FASTCCD_INVALID_PAIR);
    EXPECT(step.step == 0.0 && step.kind == FASTCCD_VERTEX_FACE && fault.pair == 2);
    EXPECT(fastccd_pairs_earliest_contact(FASTCCD_EDGE_EDGE, NULL, 0, NULL, &first, NULL) == FASTCCD_OK);
    EXPECT(first.pair == (size_t)-1 && isinf(first.toi) && first.proven == 0);
    EXPECT(fastccd_pairs_collision_free_step(NULL, 0, NULL, 0, NULL, &step, NULL) == FASTCCD_OK && step.step == 1.0 && step.pair == (size_t)-1);
    EXPECT(fastccd_pairs_earliest_contact(FASTCCD_EDGE_EDGE, NULL, 1, NULL, &first, NULL) == FASTCCD_WRONG_SIZE);
    EXPECT(fastccd_pairs_earliest_contact(FASTCCD_EDGE_EDGE, edges_met[0], 1, NULL, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
    EXPECT(fastccd_pairs_collision_free_step(NULL, 1, NULL, 0, NULL, &step, NULL) == FASTCCD_WRONG_SIZE && step.step == 0.0);
    EXPECT(fastccd_pairs_collision_free_step(NULL, 0, NULL, 0, NULL, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
}

static void test_meshes(void)
{
    fastccd_mesh mesh = make_mesh();
    const int32_t bad_pairs[] = {0, 1, 0, 2}; /* there are edges 0 and 1 */
    const int32_t bad_faces[] = {1, 2, 6};
    const int32_t bad_edges[] = {2, 3, 4, -3};
    double toi = 7.0;
    double moved[18];
    fastccd_contact contact;
    fastccd_fault fault = {77, 77};
    fastccd_step step;
    size_t found = 99;
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, NULL, NULL) == FASTCCD_OK);
    EXPECT(near(toi, 0.5));
    EXPECT(fastccd_mesh_find_contacts(&mesh, FASTCCD_EDGE_EDGE, edge_edge, 1, NULL, &contact, 1, &found, NULL, NULL) == FASTCCD_OK);
    EXPECT(found == 1 && contact.pair == 0 && near(contact.toi, 0.25));
    EXPECT(fastccd_mesh_earliest_contact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &contact, NULL, NULL) == FASTCCD_OK);
    EXPECT(contact.pair == 0 && contact.toi == toi);
    EXPECT(fastccd_mesh_earliest_contact(&mesh, FASTCCD_EDGE_EDGE, bad_pairs, 2, NULL, &contact, NULL, &fault) == FASTCCD_INDEX_OUT_OF_RANGE);
    EXPECT(contact.pair == 0 && fault.pair == 1 && fault.index == 2);
    EXPECT(fastccd_mesh_earliest_contact(&mesh, FASTCCD_EDGE_EDGE, edge_edge, 1, NULL, NULL, NULL, NULL) == FASTCCD_BAD_ARGUMENT);

    step.size = sizeof step;
    EXPECT(fastccd_mesh_collision_free_step(&mesh, vertex_face, 1, edge_edge, 1, NULL, &step, NULL) == FASTCCD_OK);
    EXPECT(step.size == sizeof step && near(step.step, 0.25) && step.kind == FASTCCD_EDGE_EDGE && step.pair == 0);
    EXPECT(fastccd_mesh_collision_free_step(&mesh, NULL, 0, NULL, 0, NULL, &step, NULL) == FASTCCD_OK);
    EXPECT(step.step == 1.0 && step.pair == (size_t)-1);

    EXPECT(fastccd_mesh_collision_free_step(&mesh, vertex_face, 1, bad_pairs, 2, NULL, &step, &fault) == FASTCCD_INDEX_OUT_OF_RANGE);
    EXPECT(step.step == 0.0 && step.kind == FASTCCD_EDGE_EDGE && fault.pair == 1 && fault.index == 2);
    memcpy(moved, end, sizeof moved);
    moved[17] = INFINITY;
    mesh.end = moved;
    EXPECT(fastccd_mesh_collision_free_step(&mesh, vertex_face, 1, edge_edge, 1, NULL, &step, &fault) == FASTCCD_INVALID_PAIR);
    EXPECT(step.step == 0.0 && step.kind == FASTCCD_EDGE_EDGE && fault.pair == 0);
    mesh = make_mesh();
    mesh.faces = bad_faces;
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, NULL, &fault) == FASTCCD_BAD_FACE_INDEX);
    EXPECT(fault.pair == 0 && fault.index == 6);
    EXPECT(strstr(fastccd_message(FASTCCD_BAD_FACE_INDEX), "face") != NULL && strstr(fastccd_message(FASTCCD_BAD_EDGE_INDEX), "edge") != NULL);
    mesh = make_mesh();
    mesh.edges = bad_edges;
    EXPECT(fastccd_mesh_collision_free_step(&mesh, vertex_face, 1, edge_edge, 1, NULL, &step, &fault) == FASTCCD_BAD_EDGE_INDEX);
    EXPECT(step.step == 0.0 && fault.pair == 1 && fault.index == -3);
    mesh = make_mesh();
    mesh.start = NULL;
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, NULL, NULL) == FASTCCD_WRONG_SIZE);
    EXPECT(fastccd_mesh_time_of_impact(NULL, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
}

/* Fields only ever get appended: programs in other languages write these offsets down. */
static void test_layout(void)
{
#if UINTPTR_MAX == UINT64_MAX
    EXPECT(offsetof(fastccd_options, tolerance) == 8 && offsetof(fastccd_options, t_max) == 16 && offsetof(fastccd_options, isa) == 24);
    EXPECT(offsetof(fastccd_options, reference) == 28 && offsetof(fastccd_options, exact) == 32 && offsetof(fastccd_options, reserved) == 36);
    EXPECT(offsetof(fastccd_options, minimum_separation) == 40 && offsetof(fastccd_options, distance_tolerance) == 48);
    EXPECT(sizeof(fastccd_options) == 64 && offsetof(fastccd_options, threads) == 56);
    EXPECT(offsetof(fastccd_mesh, vertex_count) == 8 && offsetof(fastccd_mesh, start) == 16 && offsetof(fastccd_mesh, end) == 24);
    EXPECT(offsetof(fastccd_mesh, face_count) == 32 && offsetof(fastccd_mesh, faces) == 40);
    EXPECT(offsetof(fastccd_mesh, edge_count) == 48 && offsetof(fastccd_mesh, edges) == 56);
    EXPECT(sizeof(fastccd_contact) == 24 && offsetof(fastccd_contact, toi) == 8 && offsetof(fastccd_contact, proven) == 16);
    EXPECT(offsetof(fastccd_contact, at_start) == 20 && offsetof(fastccd_summary, at_start) == 88);
    EXPECT(offsetof(fastccd_summary, pairs) == 8 && offsetof(fastccd_summary, invalid) == 48 && offsetof(fastccd_summary, scalar_pairs) == 56);
    EXPECT(offsetof(fastccd_summary, earliest_pair) == 64 && offsetof(fastccd_summary, earliest_toi) == 72 && offsetof(fastccd_summary, isa) == 80);
    EXPECT(offsetof(fastccd_step, step) == 8 && offsetof(fastccd_step, pair) == 16 && offsetof(fastccd_step, kind) == 24);
    EXPECT(sizeof(fastccd_fault) == 16 && offsetof(fastccd_fault, index) == 8);
#endif
}

/* The vertex falls from height 1 to -1; a program that does not know minimum separation has none. */
static void test_minimum_separation(void)
{
    double toi;
    fastccd_contact found;
    fastccd_summary summary;
    size_t count = 0;
    fastccd_mesh mesh = make_mesh();
    fastccd_options options;
    fastccd_options_init(&options, sizeof options);
    EXPECT(options.minimum_separation == 0.0 && options.distance_tolerance == 1e-6);
    options.minimum_separation = 0.1;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_OK && toi < 0.5 && toi > 0.4);
    options.size = 40;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_OK && near(toi, 0.5));
    options.size = sizeof options;
    options.minimum_separation = 1e3;
    summary.size = sizeof summary;
    EXPECT(fastccd_mesh_find_contacts(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, &options, &found, 1, &count, &summary, NULL) == FASTCCD_OK);
    EXPECT(count == 1 && found.toi == 0.0 && found.at_start == 1 && summary.at_start == 1);
    options.exact = 1;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_EXACT_SEPARATION);
    options.exact = 0;
    options.distance_tolerance = -1.0;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_BAD_DISTANCE_TOLERANCE);
    options.minimum_separation = -1.0;
    EXPECT(fastccd_vertex_face_toi(start, end, &options, &toi) == FASTCCD_BAD_MINIMUM_SEPARATION);
    EXPECT(strstr(fastccd_message(FASTCCD_EXACT_SEPARATION), "separation") != NULL);
}

/* A program that was compiled with a later header, and one that forgot the size. */
static void test_other_sizes(void)
{
    struct {
        fastccd_options known;
        double later;
    } options;
    struct {
        fastccd_summary known;
        double later;
    } summary;
    double toi;
    fastccd_mesh mesh = make_mesh();
    memset(&options, 0x55, sizeof options);
    fastccd_options_init(&options.known, sizeof options);
    EXPECT(options.known.size == sizeof options && options.known.tolerance == 1e-9 && options.later == 0.0);
    EXPECT(fastccd_vertex_face_toi(start, end, &options.known, &toi) == FASTCCD_OK && near(toi, 0.5));
    options.later = 1.0; /* asks for what this library cannot know */
    EXPECT(fastccd_vertex_face_toi(start, end, &options.known, &toi) == FASTCCD_BAD_ARGUMENT);
    options.known.size = 0;
    EXPECT(fastccd_vertex_face_toi(start, end, &options.known, &toi) == FASTCCD_BAD_ARGUMENT);
    options.known.size = sizeof options.known;
    options.known.threads = -1;
    EXPECT(fastccd_vertex_face_toi(start, end, &options.known, &toi) == FASTCCD_BAD_ARGUMENT);
    options.known.size = offsetof(fastccd_options, threads); /* compiled before there were threads: not read */
    EXPECT(fastccd_vertex_face_toi(start, end, &options.known, &toi) == FASTCCD_OK && near(toi, 0.5));

    summary.known.size = sizeof summary;
    summary.later = 1.0;
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, &summary.known, NULL) == FASTCCD_OK);
    EXPECT(summary.known.size == sizeof summary && summary.known.pairs == 1 && summary.later == 0.0);
    summary.known.size = 8;
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, &summary.known, NULL) == FASTCCD_BAD_ARGUMENT);
    memset(&summary, 0xcc, sizeof summary); /* not initialised */
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, &summary.known, NULL) == FASTCCD_BAD_ARGUMENT);
    mesh.size = 8;
    EXPECT(fastccd_mesh_time_of_impact(&mesh, FASTCCD_VERTEX_FACE, vertex_face, 1, NULL, &toi, NULL, NULL, NULL) == FASTCCD_BAD_ARGUMENT);
}

int main(void)
{
    test_threads();
    test_queries();
    test_single_pairs();
    test_packed_pairs();
    test_first_of_packed_pairs();
    test_meshes();
    test_layout();
    test_minimum_separation();
    test_other_sizes();
    if (failures == 0) puts("the C interface is as promised");
    return failures == 0 ? 0 : 1;
}
