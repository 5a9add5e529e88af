// Pairs on which rounding is amplified most: thin faces, edges that are nearly parallel or short, close by but apart
// (or not), in fast motion along their own plane. The families of generators.hpp touch; these mostly just miss.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "oracle/pair.hpp"

namespace fastccd::testing {

class ThinPairs {
public:
    ThinPairs(oracle::Kind kind, std::uint64_t seed) : kind_{kind}, bits_{seed} {}

    /// `closest`: when they are that; otherwise at some time.
    oracle::Pair next_closest_at(std::optional<double> closest)
    {
        const bool vertex_face = kind_ == oracle::Kind::vertex_face;
        const double width = decades(-14, 0), height = 0.1 * decades(-14, 0), length = decades(-8, 0), travel = decades(-8, 0);
        const Frame frame = random_frame();

        // In the frame: along the length, across it (scaled by `width`), and `height` between the primitives.
        double at[4][3] = {};
        if (vertex_face) {
            const double corner[3][2] = {{0, 0}, {1, uniform(-1, 1)}, {uniform(0, 1), 1}};
            const double a = uniform(0, 1), b = uniform(0, 1), c = uniform(0, 1), sum = a + b + c;
            for (int k = 0; k < 2; ++k) {
                at[0][k] = (a * corner[0][k] + b * corner[1][k] + c * corner[2][k]) / sum;
                for (int i = 0; i < 3; ++i) at[i + 1][k] = corner[i][k];
            }
            at[0][2] = height;
        } else {
            const double shrink = uniform(0, 1) < 0.3 ? decades(-6, 0) : 1.0;
            const double quadrant[4][2] = {{-1, -1}, {1, 1}, {-1, 1}, {1, -1}};  // the edges cross
            for (int i = 0; i < 4; ++i)
                for (int k = 0; k < 2; ++k) at[i][k] = quadrant[i][k] * uniform(0, 1) * (i < 2 ? 1.0 : shrink);
            at[0][2] = at[1][2] = height;
        }
        const double some_time = uniform(0, 1), passing = closest.value_or(some_time);
        const double velocity[2] = {uniform(-travel, travel), uniform(-travel, travel)};
        oracle::Pair pair;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                double x = 0, v = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    x += frame[k][axis] * at[i][k] * length * (k == 1 ? width : 1.0);
                    if (k < 2 && i < (vertex_face ? 1 : 2)) v += frame[k][axis] * velocity[k];
                }
                pair[i][axis] = x - passing * v;
                pair[i + 4][axis] = x + (1 - passing) * v;
            }
        return pair;
    }

    oracle::Pair next() { return next_closest_at(std::nullopt); }

    std::vector<oracle::Pair> next(std::size_t n)
    {
        std::vector<oracle::Pair> pairs(n);
        for (oracle::Pair& pair : pairs) pair = next();
        return pairs;
    }

private:
    using Frame = std::array<std::array<double, 3>, 3>;

    double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
    double decades(double low, double high) { return std::pow(10.0, uniform(low, high)); }

    Frame random_frame()
    {
        Frame f;
        for (auto& row : f)
            for (double& x : row) x = uniform(-1, 1);
        const auto normalise = [](std::array<double, 3>& v) {
            const double length = std::hypot(v[0], v[1], v[2]);
            for (double& x : v) x /= length;
        };
        normalise(f[0]);
        const double along = f[0][0] * f[1][0] + f[0][1] * f[1][1] + f[0][2] * f[1][2];
        for (std::size_t k = 0; k < 3; ++k) f[1][k] -= along * f[0][k];
        normalise(f[1]);
        for (std::size_t k = 0; k < 3; ++k)
            f[2][k] = f[0][(k + 1) % 3] * f[1][(k + 2) % 3] - f[0][(k + 2) % 3] * f[1][(k + 1) % 3];
        return f;
    }

    oracle::Kind kind_;
    std::mt19937_64 bits_;
};

}  // namespace fastccd::testing
