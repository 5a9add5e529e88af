// One pair at a time gives the same bits as a batch.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "generators.hpp"
#include "narrow_phase.hpp"

namespace fastccd::testing {
namespace {

PairToi single(oracle::Kind kind, const oracle::Pair& pair, const Options& options)
{
    const std::span<const Point, 4> x0{pair.data(), 4}, x1{pair.data() + 4, 4};
    return kind == oracle::Kind::vertex_face ? vertex_face_toi(x0, x1, options) : edge_edge_toi(x0, x1, options);
}

TEST(SinglePair, SameBitsAsTheBatch)
{
    for (const auto kind : {oracle::Kind::vertex_face, oracle::Kind::edge_edge})
        for (const std::string& family : families()) {
            std::vector<oracle::Pair> pairs;
            generate(family, kind, 81, 60, pairs);
            for (const double separation : {0.0, 1e-3})
                for (const double t_max : {1.0, 0.4}) {
                    const double tolerance = t_max == 1.0 ? 1e-9 : 1e-3;
                    Options options;
                    options.minimum_separation = separation;
                    options.tolerance = tolerance;
                    options.t_max = t_max;
                    const Answer batch = answer(kind, interleaved(pairs), options);
                    std::size_t proven = 0, at_start = 0;
                    for (std::size_t i = 0; i < pairs.size(); ++i) {
                        const PairToi found = single(kind, pairs[i], options);
                        ASSERT_TRUE(found.status.ok());
                        ASSERT_EQ(std::memcmp(&found.toi, &batch.toi[i], sizeof(double)), 0)
                            << kind_name(kind) << ' ' << family << ' ' << lossless(pairs[i]);
                        proven += found.proven;
                        at_start += found.at_start;
                    }
                    EXPECT_EQ(at_start, batch.summary.at_start) << kind_name(kind) << ' ' << family;
                    EXPECT_EQ(proven, batch.summary.proven) << kind_name(kind) << ' ' << family;
                }
        }
}

TEST(SinglePair, FallsOntoTheFace)
{
    const Point x0[4] = {{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, x1[4] = {{0, 0, -1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    const PairToi found = vertex_face_toi(x0, x1);
    EXPECT_LE(found.toi, 0.5);
    EXPECT_GE(found.toi, 0.5 - 1e-9);
    EXPECT_TRUE(found.proven);
    for (const Isa isa : {Isa::avx512, Isa::neon, Isa::scalar}) {
        Options any;
        any.isa = isa;
        EXPECT_EQ(vertex_face_toi(x0, x1, any).toi, found.toi) << "whether this machine has it or not: " << name(isa);
    }
    Options shorter;
    shorter.t_max = 0.25;
    EXPECT_EQ(vertex_face_toi(x0, x1, shorter).toi, std::numeric_limits<double>::infinity());
    // As two edges, x0 x1 and x2 x3, the same points do touch, but not there.
    EXPECT_NE(edge_edge_toi(x0, x1).toi, found.toi);
}

TEST(SinglePair, ErrorsAndInvalidPairs)
{
    Point x0[4] = {{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, x1[4] = {{0, 0, -1}, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    Options options;
    options.tolerance = 0.0;
    EXPECT_EQ(edge_edge_toi(x0, x1, options).status.error, Error::bad_tolerance);
    EXPECT_TRUE(std::isnan(edge_edge_toi(x0, x1, options).toi));
    options = {};
    options.t_max = 2.0;
    EXPECT_EQ(vertex_face_toi(x0, x1, options).status.error, Error::bad_t_max);
    x1[3][2] = std::numeric_limits<double>::infinity();
    const PairToi invalid = vertex_face_toi(x0, x1);
    EXPECT_TRUE(invalid.status.ok());
    EXPECT_TRUE(std::isnan(invalid.toi));
    EXPECT_FALSE(invalid.proven);
}

}  // namespace
}  // namespace fastccd::testing
