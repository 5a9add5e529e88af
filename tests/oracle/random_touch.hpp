#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "pair.hpp"

namespace fastccd::testing {

using Vector = std::array<double, 3>;
using Points = std::array<Vector, 4>;

inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// Points that touch, and how: VF x0 = x1 + a u + b v with u = x2 - x1, v = x3 - x1;
/// EE x0 + a u = x2 + b v with u = x1 - x0, v = x3 - x2.
struct Touch {
    Points x;
    Vector u, v;
    double a, b;
};

enum class Where { interior, boundary };

/// Random numbers, vectors and touching positions: what generators.cpp makes its pairs of.
class Source {
public:
    Source(oracle::Kind kind, bool single, std::uint64_t seed) : kind_(kind), single_(single), bits_(seed) {}

    bool vertex_face() const { return kind_ == oracle::Kind::vertex_face; }
    bool single() const { return single_; }

    // --- numbers. The library's distributions differ between standard libraries; these do not. ---
    double unit() { return std::ldexp(static_cast<double>(bits_() >> 11), -53); }  // [0, 1)
    double uniform(double lo, double hi) { return lo + (hi - lo) * unit(); }
    int integer(int lo, int hi) { return lo + static_cast<int>(bits_() % static_cast<std::uint64_t>(hi - lo + 1)); }
    bool chance(double p) { return unit() < p; }
    double sign() { return chance(0.5) ? 1.0 : -1.0; }
    // About 10^lo .. 10^hi, logarithmically; without std::pow, whose last bit differs between libraries.
    double size(double lo, double hi) {
        const double binary = uniform(lo, hi) * 3.3219280948873623;  // log2(10)
        const double whole = std::floor(binary);
        return std::ldexp(1.0 + (binary - whole), static_cast<int>(whole));
    }

    // --- exact numbers: so few bits that the constructions below stay within a float's or double's 24 or 53 ---
    double on_grid(int range) {
        const int scale = 1 << (single_ ? 6 : 16);
        return static_cast<double>(integer(-range * scale, range * scale)) / scale;
    }
    Vector grid_vector(int range = 1) { return {on_grid(range), on_grid(range), on_grid(range)}; }
    double eighth(int lo, int hi) { return integer(lo, hi) / 8.0; }
    double inner_time() { return single_ ? integer(1, 7) / 8.0 : integer(1, 63) / 64.0; }
    Vector integer_vector(int lo, int hi) {
        return {double(integer(lo, hi)), double(integer(lo, hi)), double(integer(lo, hi))};
    }
    Vector uniform_vector(double lo = -1.0, double hi = 1.0) {
        return {uniform(lo, hi), uniform(lo, hi), uniform(lo, hi)};
    }
    template <class Make>
    Points four(Make make) {
        return {make(), make(), make(), make()};
    }
    template <class Make>
    std::array<Vector, 3> three(Make make) {
        return {make(), make(), make()};
    }

    // --- positions that touch ---
    Touch touch(const Vector& at, const Vector& u, const Vector& v, double a, double b) const {
        if (vertex_face()) {
            const Vector x1 = at - (a * u + b * v);
            return {{at, x1, x1 + u, x1 + v}, u, v, a, b};
        }
        const Vector x0 = at - a * u, x2 = at - b * v;
        return {{x0, x0 + u, x2, x2 + v}, u, v, a, b};
    }
    std::pair<double, double> weights(Where where) {
        if (where == Where::interior) {
            const int a = integer(1, 6);
            return {a / 8.0, vertex_face() ? eighth(1, 7 - a) : eighth(1, 7)};
        }
        if (!vertex_face()) return {integer(0, 1), chance(0.3) ? integer(0, 1) : eighth(1, 7)};
        const double a = eighth(0, 8);
        return chance(0.3) ? std::pair(0.0, a) : chance(0.5) ? std::pair(a, 0.0) : std::pair(a, 1.0 - a);
    }
    Touch exact_touch(Where where) {
        const auto [a, b] = weights(where);
        const auto [at, u, v] = three([&] { return grid_vector(); });
        return touch(at, u, v, a, b);
    }
    Touch rounded_touch(Where where) {
        auto [a, b] = weights(where);
        if (where == Where::interior) {
            a = uniform(0.1, 0.45);
            b = uniform(0.1, 0.45);
        }
        const auto [at, u, v] = three([&] { return uniform_vector(); });
        return touch(at, u, v, a, b);
    }

    // Velocities that give the two points in touch the same velocity up to sliding within the plane: the cubic's
    // derivative, normal . relative velocity, vanishes, so its root is (at least) double. Exact for grid arguments.
    Points tangential_velocities(const Touch& t, const Vector& sliding, const Points& free) const {
        if (vertex_face()) {  // v0 = weighted velocity of the face + sliding
            const Vector face = free[1] + t.a * (free[2] - free[1]) + t.b * (free[3] - free[1]);
            return {face + sliding, free[1], free[2], free[3]};
        }
        // (1 - b)(-b m) + b (1 - b) m = 0, so the point in touch on x2 x3 moves with `point`, whatever m
        const Vector point = free[0] + t.a * (free[1] - free[0]) + sliding;
        return {free[0], free[1], point - t.b * free[2], point + (1.0 - t.b) * free[2]};
    }
    Vector in_plane(const Touch& t) {
        const double along_u = eighth(-8, 8), along_v = eighth(-8, 8);
        return along_u * t.u + along_v * t.v;
    }

private:
    oracle::Kind kind_;
    bool single_;
    std::mt19937_64 bits_;
};

}  // namespace fastccd::testing
