// The header-only adapters, by behaviour: Eigen views, calls as those of Tight-Inclusion, a class as that of IPC Toolkit.
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <limits>
#include <random>

#include <fastccd/adapters/ipc_toolkit.hpp>
#include <fastccd/adapters/tight_inclusion.hpp>
#include <fastccd/eigen.hpp>

#include "generators.hpp"
#include "narrow_phase.hpp"
#include "oracle/exact_ccd.hpp"
#include "oracle/exact_distance.hpp"

namespace ticcd = fastccd::tight_inclusion;

namespace fastccd::testing {
namespace {

using Eigen::Vector3d;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The points of a pair as these interfaces want them.
struct Vectors {
    Vector3d x[8];
    explicit Vectors(const oracle::Pair& pair)
    {
        for (std::size_t i = 0; i < 8; ++i) x[i] = {pair[i][0], pair[i][1], pair[i][2]};
    }
};

struct Asked {
    double separation = 0.0, tolerance = 1e-6, t_max = 1.0;
    bool no_zero_toi = false;
};

bool ask_tight_inclusion(oracle::Kind kind, const oracle::Pair& pair, const Asked& asked, double& toi)
{
    const auto& x = Vectors{pair}.x;
    double output_tolerance = -1.0;
    const Eigen::Array3d err = Eigen::Array3d::Constant(-1);
    const bool hit = kind == oracle::Kind::vertex_face
        ? ticcd::vertexFaceCCD(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], err, asked.separation, toi, asked.tolerance,
                               asked.t_max, 1000000, output_tolerance, asked.no_zero_toi)
        : ticcd::edgeEdgeCCD(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], err, asked.separation, toi, asked.tolerance, asked.t_max,
                             -1, output_tolerance, asked.no_zero_toi, ticcd::CCDRootFindingMethod::DEPTH_FIRST_SEARCH);
    EXPECT_EQ(output_tolerance, asked.tolerance);
    return hit;
}

bool ask_ipc_toolkit(oracle::Kind kind, const oracle::Pair& pair, const Asked& asked, double& toi)
{
    NarrowPhaseCCD ccd;
    ccd.tolerance = asked.tolerance;
    const auto& x = Vectors{pair}.x;
    return kind == oracle::Kind::vertex_face
        ? ccd.point_triangle_ccd(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], toi, asked.separation, asked.t_max)
        : ccd.edge_edge_ccd(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], toi, asked.separation, asked.t_max);
}

const oracle::Pair falling{{{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, -1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}};

class Adapter : public ::testing::TestWithParam<bool (*)(oracle::Kind, const oracle::Pair&, const Asked&, double&)> {};

TEST_P(Adapter, AgreesWithExactTruthToWithinItsDistance)
{
    std::size_t hits = 0;
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const std::string family : {"uniform", "t0_contact", "t1_contact", "grazing_exact", "pointpoint", "extreme_scale", "resting"}) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 71, 60, pairs);
            for (const double t_max : {1.0, 0.5})
                for (const oracle::Pair& pair : pairs) {
                    const oracle::Verdict truth = oracle::exact_ccd(kind, pair, t_max);
                    double toi = -1.0;
                    const bool hit = GetParam()(kind, pair, {0.0, 1e-6, t_max, true}, toi);
                    if (!hit) {
                        ASSERT_FALSE(truth.contact) << family << ' ' << lossless(pair);
                        EXPECT_EQ(toi, infinity);
                        continue;
                    }
                    EXPECT_LE(toi, truth.contact ? truth.t_lo : t_max) << family << ' ' << lossless(pair);
                    EXPECT_GE(toi, 0.0);
                    ++hits;
                    const mpq_class size = oracle::sum_of_extents(pair);
                    EXPECT_LE(oracle::excess_of_distance(kind, pair, toi, 1e-6, size), 0x1p12 * 0x1p-53) << family << ' ' << lossless(pair);
                }
        }
    EXPECT_GT(hits, 400u);
}

TEST_P(Adapter, ToleranceIsADistance)
{
    // The vertex falls by 2 in the step; scaled pairs fall farther for the same tolerance.
    for (const double scale : {1.0, 1e-3, 1e3})
        for (const double tolerance : {1e-3, 1e-6}) {
            oracle::Pair pair = falling;
            pair[0][2] = 0.9;  // contact at 9/19: no end of any leaf
            for (auto& point : pair)
                for (double& x : point) x *= scale;
            double toi = -1.0;
            ASSERT_TRUE(GetParam()(oracle::Kind::vertex_face, pair, {0.0, tolerance, 1.0}, toi));
            EXPECT_LE(toi, 9.0 / 19.0);
            EXPECT_LE((9.0 / 19.0 - toi) * 1.9 * scale, tolerance * (1 + 1e-9)) << scale;
        }
    double toi = -1.0;
    ASSERT_TRUE(GetParam()(oracle::Kind::vertex_face, falling, {0.0, 1.0, 1.0}, toi));
    EXPECT_LT(toi, 0.5) << "a coarse tolerance is used as such";
    ASSERT_TRUE(GetParam()(oracle::Kind::vertex_face, falling, {0.0, infinity, 1.0}, toi));
    EXPECT_LT(toi, 0.5);
    // The largest displacement is beyond all doubles.
    constexpr double b = 1e308;
    const oracle::Pair huge{{{-b, -b, -b}, {b, b, b}, {b, b, 0}, {b, 0, 0}, {b, b, b}, {-b, -b, -b}, {-b, -b, 0}, {-b, 0, 0}}};
    for (const double tolerance : {1e-6, 1e300, infinity}) EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, huge, {0.0, tolerance, 1.0}, toi)) << tolerance;
}

TEST_P(Adapter, ShorterStepsDownToTheStartAlone)
{
    double toi = -1.0;
    EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, falling, {0.0, 1e-6, 0.6}, toi));
    EXPECT_FALSE(GetParam()(oracle::Kind::vertex_face, falling, {0.0, 1e-6, 0.4}, toi));
    EXPECT_FALSE(GetParam()(oracle::Kind::vertex_face, falling, {0.0, 1e-6, 0.0}, toi));
    EXPECT_EQ(toi, infinity);
    oracle::Pair touching = falling;
    touching[0][2] = 0.0;
    EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, touching, {0.0, 1e-6, 0.0}, toi));
    EXPECT_EQ(toi, 0.0);
    // Nothing moves at all.
    for (std::size_t i = 0; i < 4; ++i) touching[4 + i] = touching[i];
    EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, touching, {}, toi));
    EXPECT_EQ(toi, 0.0);
}

/// Programs that look for their own mistakes trap these.
TEST_P(Adapter, DividesByNothingThatIsZero)
{
    oracle::Pair at_rest = falling;
    for (std::size_t i = 0; i < 4; ++i) at_rest[4 + i] = at_rest[i];
    std::feclearexcept(FE_ALL_EXCEPT);
    const int before = fegetexcept();
    feenableexcept(FE_DIVBYZERO | FE_OVERFLOW | FE_INVALID);
    double toi = -1.0;
    bool hits = false;
    for (const double separation : {0.0, 1e-3, std::numeric_limits<double>::denorm_min()})
        for (const double tolerance : {1e-6, infinity}) hits |= GetParam()(oracle::Kind::vertex_face, at_rest, {separation, tolerance, 1.0}, toi);
    feenableexcept(before);
    fedisableexcept(~before & FE_ALL_EXCEPT);
    EXPECT_FALSE(hits);
}

TEST_P(Adapter, NeverZeroIfApartAtTheStart)
{
    oracle::Pair close = falling;
    close[0][2] = 1e-9;  // far below the tolerance
    for (const bool no_zero_toi : {false, true}) {
        double toi = -1.0;
        EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, close, {0.0, 1e-6, 1.0, no_zero_toi}, toi));
        EXPECT_GT(toi, 0.0);
    }
}

TEST_P(Adapter, MinimumSeparation)
{
    // The vertex falls from height 1 to -1: within 0.1 at 9/20.
    double toi = -1.0;
    EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, falling, {0.1}, toi));
    EXPECT_LE(toi, 0.45);
    EXPECT_GE(toi, 0.45 - 1e-6);
    EXPECT_FALSE(GetParam()(oracle::Kind::vertex_face, falling, {0.1, 1e-6, 0.4}, toi));
    EXPECT_TRUE(GetParam()(oracle::Kind::vertex_face, falling, {1.5}, toi));
    EXPECT_EQ(toi, 0.0);
}

TEST_P(Adapter, AtItsTimeAPairIsAsCloseAsTheMinimumSeparationPlusTheTolerance)
{
    // A vertex passes the corner x1 at a distance that is 0.8 at its least: a square root of time, which no division gives.
    const oracle::Pair passing{{{-3, 0.8, 0}, {0, 0, 0}, {-1, -2, 0}, {1, -2, 0}, {3, 0.8, 0}, {0, 0, 0}, {-1, -2, 0}, {1, -2, 0}}};
    for (const double scale : {1.0, 1e-3, 1e3})
        for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
            oracle::Pair pair = passing;
            for (auto& point : pair)
                for (double& x : point) x *= scale;
            double toi = -1.0;
            ASSERT_TRUE(GetParam()(oracle::Kind::vertex_face, pair, {scale, tolerance * scale}, toi));
            const double x = 6 * toi - 3, farther = std::sqrt(x * x + 0.64) - 1.0;
            EXPECT_GE(farther, -1e-14);
            EXPECT_LE(farther, tolerance + 1e-13);
        }
}

TEST_P(Adapter, WhatCannotBeAnsweredIsAnError)
{
    double toi = 7.0;
    const auto ask = [&](const oracle::Pair& pair, const Asked& asked) { (void)GetParam()(oracle::Kind::vertex_face, pair, asked, toi); };
    for (const double bad : {-1e-3, infinity, std::numeric_limits<double>::quiet_NaN()}) EXPECT_THROW(ask(falling, {bad}), std::invalid_argument);
    EXPECT_THROW(ask(falling, {0.0, 1e-6, 1.5}), std::invalid_argument);
    EXPECT_THROW(ask(falling, {0.0, 1e-6, -0.1}), std::invalid_argument);
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) EXPECT_THROW(ask(falling, {0.0, bad, 1.0}), std::invalid_argument);
    oracle::Pair invalid = falling;
    invalid[6][1] = infinity;
    EXPECT_THROW(ask(invalid, {}), std::invalid_argument);
    EXPECT_EQ(toi, 7.0);
}

INSTANTIATE_TEST_SUITE_P(TightInclusion, Adapter, ::testing::Values(&ask_tight_inclusion));
INSTANTIATE_TEST_SUITE_P(IpcToolkit, Adapter, ::testing::Values(&ask_ipc_toolkit));

TEST(Adapters, DisplacementOfPointsFartherApartThanDoublesReach)
{
    const double far = 1.7e308;
    const Vector3d from{far, 0, 0}, to{far, 0, 1}, left{-far, 0, 0}, below{-far, -far, 0}, above{-far, far, 0};
    const adapters::MovingPair pair{from, left, below, above, to, left, below, above};
    EXPECT_EQ(pair.largest_displacement(PairKind::vertex_face), 1.0);
}

TEST(IpcToolkit, PointsAndEdgesInSpaceAndInThePlane)
{
    const NarrowPhaseCCD ccd;
    double toi = -1.0;
    const Vector3d a{0, 0, 0}, b{1, 2, 3}, left{-1, 0, 1}, right{1, 0, 1}, above{0, 0, 3}, beside{3, 0, 1};
    EXPECT_TRUE(ccd.point_point_ccd(a, b, b, a, toi));  // they change places
    EXPECT_LE(toi, 0.5);
    EXPECT_GE(toi, 0.5 - 1e-6);
    EXPECT_FALSE(ccd.point_point_ccd(a, b, a, a, toi, 0.0, 0.9));
    EXPECT_EQ(toi, infinity);
    EXPECT_FALSE(ccd.point_point_ccd(a, b, right, b, toi));

    EXPECT_TRUE(ccd.point_edge_ccd(above, left, right, a, left, right, toi));  // falls by 3, through z = 1
    EXPECT_LE(toi, 2.0 / 3.0);
    EXPECT_GE(toi, 2.0 / 3.0 - 1e-6);
    EXPECT_FALSE(ccd.point_edge_ccd(above, left, right, beside, left, right, toi));

    const Eigen::Vector2d p0{0.25, 1}, p1{0.25, -1}, e0{-1, 0}, e1{1, 0}, far{5, 0};
    EXPECT_TRUE(ccd.point_edge_ccd(p0, e0, e1, p1, e0, e1, toi));
    EXPECT_LE(toi, 0.5);
    EXPECT_GE(toi, 0.5 - 1e-6);
    EXPECT_FALSE(ccd.point_edge_ccd(p0, e0, e1, far, e0, e1, toi));
    EXPECT_TRUE(ccd.point_point_ccd(p0, e0, e0, p0, toi));
    const Eigen::VectorXd line = Eigen::VectorXd::Zero(1);
    EXPECT_THROW((void)ccd.point_point_ccd(line, line, line, line, toi), std::invalid_argument);
    EXPECT_TRUE(ccd.point_edge_ccd(p0, e0, e1, far, e0, e1, toi, 1.5));  // 1 away at the start
    EXPECT_EQ(toi, 0.0);
}

template <class Matrix>
concept Viewable = requires(Matrix&& matrix) { positions(std::forward<Matrix>(matrix)); };
static_assert(Viewable<Eigen::MatrixXd&> && Viewable<const Eigen::MatrixXf&>);
static_assert(!Viewable<Eigen::MatrixXd>, "a view of a temporary would dangle");

TEST(EigenAdapter, ViewsOfEitherStorageOrderAndOfBlocks)
{
    std::mt19937_64 random{72};
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    const int n = 40;
    Eigen::MatrixXd start(n, 3), end(n, 3);
    for (int i = 0; i < n; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            start(i, axis) = unit(random);
            end(i, axis) = unit(random);
        }
    Eigen::MatrixXi faces(10, 3), edges(20, 2);
    for (int i = 0; i < 10; ++i) faces.row(i) << 3 * i, 3 * i + 1, 3 * i + 2;
    for (int i = 0; i < 20; ++i) edges.row(i) << 2 * i, 2 * i + 1;
    std::vector<VertexFace> vertex_face;
    std::vector<EdgeEdge> edge_edge;
    for (int i = 0; i < 10; ++i)
        for (int v = 0; v < 3 * i; ++v) vertex_face.push_back({v, i});
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < i; ++j) edge_edge.push_back({i, j});
    const auto answers = [&](const MovingMesh& mesh) {
        EXPECT_TRUE(mesh.status().ok()) << message(mesh.status().error);
        std::vector<double> toi(vertex_face.size() + edge_edge.size());
        const std::span<double> all{toi};
        EXPECT_TRUE(time_of_impact(mesh, vertex_face, {}, all.first(vertex_face.size())).ok());
        EXPECT_TRUE(time_of_impact(mesh, edge_edge, {}, all.subspan(vertex_face.size())).ok());
        return toi;
    };
    const MovingMesh columns{positions(start), positions(end), fastccd::faces(faces), fastccd::edges(edges)};
    const std::vector<double> expected = answers(columns);
    std::size_t contacts = 0;
    for (std::size_t k = 0; k < expected.size(); ++k) contacts += std::isfinite(expected[k]);
    EXPECT_GT(contacts, 10u);
    // The single calls see the same points.
    for (std::size_t k = 0; k < vertex_face.size(); ++k) {
        const int v = vertex_face[k].vertex, f = 3 * vertex_face[k].face;
        const auto at = [](const Eigen::MatrixXd& x, int row) { return Vector3d{x.row(row).transpose()}; };
        EXPECT_EQ(vertex_face_toi(at(start, v), at(start, f), at(start, f + 1), at(start, f + 2), at(end, v), at(end, f), at(end, f + 1),
                                  at(end, f + 2)).toi, expected[k]);
    }
    for (std::size_t k = 0; k < edge_edge.size(); ++k) {
        const int a = 2 * edge_edge[k].edge_a, b = 2 * edge_edge[k].edge_b;
        const auto at = [](const Eigen::MatrixXd& x, int row) { return Vector3d{x.row(row).transpose()}; };
        EXPECT_EQ(edge_edge_toi(at(start, a), at(start, a + 1), at(start, b), at(start, b + 1), at(end, a), at(end, a + 1), at(end, b),
                                at(end, b + 1)).toi, expected[vertex_face.size() + k]);
    }

    using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    using IndexRows = Eigen::Matrix<std::int32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Rows start_rows = start;
    const IndexRows face_rows = faces, edge_rows = edges;
    Eigen::MatrixXd both(2 * n, 7);
    both.setConstant(99.0);
    both.block(n, 2, n, 3) = end;
    const auto block = both.block(n, 2, n, 3);
    EXPECT_EQ(answers({positions(start_rows), positions(block), fastccd::faces(face_rows), fastccd::edges(edge_rows)}), expected);

    const Eigen::MatrixXd plane = start.leftCols(2);
    EXPECT_EQ((MovingMesh{positions(plane), positions(plane), {}, {}}.status().error), Error::wrong_size);
    EXPECT_EQ((MovingMesh{positions(start), positions(end), fastccd::faces(edges), {}}.status().error), Error::wrong_size);
}

}  // namespace
}  // namespace fastccd::testing
