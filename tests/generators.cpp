#include "generators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "oracle/random_touch.hpp"

namespace fastccd::testing {
namespace {

using oracle::Kind;
using oracle::Pair;

// Operands of + and *, and arguments of functions, are evaluated in an order that compilers choose. So that all of them
// draw the same numbers, no two draws are in one expression below, except where the order is fixed: { , } and ? : .

// x at time t with velocity v: from x - t v to x + (1 - t) v.
Pair moving(const Points& x, const Points& v, double t) {
    Pair pair;
    for (std::size_t i = 0; i < 4; ++i) {
        pair[i] = x[i] - t * v[i];
        pair[i + 4] = x[i] + (1.0 - t) * v[i];
    }
    return pair;
}

Pair from_to(const Points& begin, const Points& end) {
    return {begin[0], begin[1], begin[2], begin[3], end[0], end[1], end[2], end[3]};
}

// A neighbour of x some ulps away, of the type the coordinates have.
double nudge(Source& s, double x, int ulps) {
    const double toward = s.sign() * std::numeric_limits<double>::infinity();
    for (int i = 0; i < ulps; ++i) {
        x = s.single() ? double(std::nextafter(static_cast<float>(x), static_cast<float>(toward)))
                       : std::nextafter(x, toward);
    }
    return x;
}

Pair nudged(Source& s, Pair pair) {
    for (int i = s.integer(1, 3); i > 0; --i) {
        const auto point = static_cast<std::size_t>(s.integer(0, 7)), axis = static_cast<std::size_t>(s.integer(0, 2));
        pair[point][axis] = nudge(s, pair[point][axis], s.integer(1, 4));
    }
    return pair;
}

Pair map(const Pair& pair, auto function) {  // function(coordinate, axis)
    Pair result;
    for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) result[i][axis] = function(pair[i][axis], axis);
    }
    return result;
}

Pair scaled(const Pair& pair, double factor) {
    return map(pair, [&](double x, std::size_t) { return factor * x; });
}

Pair from_anywhere_to_anywhere(Source& s, auto point) {
    const Points begin = s.four(point), end = s.four(point);
    return from_to(begin, end);
}

Pair uniform(Source& s) {
    return from_anywhere_to_anywhere(s, [&] { return s.uniform_vector(0, 1); });
}

Pair grid(Source& s, int lo, int hi) {
    return from_anywhere_to_anywhere(s, [&] { return s.integer_vector(lo, hi); });
}

// Ordinary pairs, more than half of them in contact: what the families about numbers start from.
Pair ordinary(Source& s) {
    if (s.chance(0.4)) return uniform(s);
    const Points x = s.rounded_touch(Where::interior).x, v = s.four([&] { return s.uniform_vector(); });
    return moving(x, v, s.unit());
}

Pair exact_contact(Source& s, Where where, double t) {
    const Points x = s.exact_touch(where).x, v = s.four([&] { return s.grid_vector(); });
    return moving(x, v, t);
}

Pair rounded_contact(Source& s, Where where) {
    const Points x = s.rounded_touch(where).x, v = s.four([&] { return s.uniform_vector(); });
    return moving(x, v, s.uniform(0.1, 0.9));
}

// Nearly a double root: the tangential motion, moved off by 1e-3 .. 1e-17.
Pair grazing(Source& s) {
    const Touch t = s.rounded_touch(Where::interior);
    const double along_u = s.uniform(-1, 1), along_v = s.uniform(-1, 1);
    const Vector sliding = along_u * t.u + along_v * t.v;
    const Points v = s.tangential_velocities(t, sliding, s.four([&] { return s.uniform_vector(); }));
    Points x = t.x;
    const double miss = s.size(s.single() ? -9 : -17, -3);
    x[0] = x[0] + miss * s.uniform_vector();
    return moving(x, v, s.uniform(0.1, 0.9));
}

Pair grazing_exact(Source& s) {
    const Touch t = s.exact_touch(s.chance(0.7) ? Where::interior : Where::boundary);
    const Vector sliding = s.in_plane(t);
    const Points v = s.tangential_velocities(t, sliding, s.four([&] { return s.grid_vector(); }));
    const Pair pair = moving(t.x, v, s.chance(0.1) ? s.integer(0, 1) : s.inner_time());
    return s.chance(0.7) ? pair : nudged(s, pair);
}

Pair at_end_point(Source& s, double t) {
    const Pair pair = exact_contact(s, s.chance(0.6) ? Where::interior : Where::boundary, t);
    return s.chance(0.6) ? pair : nudged(s, pair);
}

// Motion within a fixed plane o + y e + z f. Half the time a vertex, or an end point of the second edge, meets a side
// of the face, or the first edge, at a known time: that is how first contact within a plane begins.
Pair planar(Source& s) {
    const Vector o = s.grid_vector(), e = s.integer_vector(-3, 3), f = s.integer_vector(-3, 3);
    Pair flat = from_anywhere_to_anywhere(s, [&] { return s.grid_vector(); });
    if (s.chance(0.5)) {
        const Vector at = s.grid_vector(), side = s.grid_vector();
        const double a = s.eighth(0, 8);
        Points x = s.four([&] { return s.grid_vector(); });
        const std::size_t hit = s.vertex_face() ? 0 : 2, from = s.vertex_face() ? 1 : 0;
        x[hit] = at;
        x[from] = at - a * side;
        x[from + 1] = x[from] + side;
        const Points v = s.four([&] { return s.grid_vector(); });
        flat = moving(x, v, s.eighth(0, 8));
    }
    Pair pair;
    for (std::size_t i = 0; i < 8; ++i) pair[i] = o + flat[i][1] * e + flat[i][2] * f;
    return pair;
}

Pair coplanar_map(Source& s) {
    const Vector drift = s.grid_vector();
    Pair pair = planar(s);
    for (std::size_t i = 4; i < 8; ++i) pair[i] = pair[i] + drift;
    return pair;
}

Pair coplanar_grid(Source& s) {
    Pair pair = grid(s, -2, 2);
    const auto axis = static_cast<std::size_t>(s.integer(0, 2));
    const double begin = s.integer(-2, 2), end = s.integer(-2, 2);
    for (std::size_t i = 0; i < 8; ++i) pair[i][axis] = i < 4 ? begin : end;
    return pair;
}

Pair collinear(Source& s) {
    const Vector begin = s.integer_vector(-3, 3), end = s.integer_vector(-3, 3);
    const Vector along = s.integer_vector(-3, 3), drift = s.grid_vector();
    const bool turning = s.chance(0.2);
    Pair pair;
    for (std::size_t i = 0; i < 8; ++i) {
        pair[i] = (i < 4 ? begin : end + drift) + s.on_grid(2) * (turning && i >= 4 ? end : along);
    }
    if (s.chance(0.5)) {  // start well apart along the line
        pair[0] = pair[0] + 6.0 * along;
        if (!s.vertex_face()) pair[1] = pair[1] + 6.0 * along;
    }
    return pair;
}

// Zero now and then.
Vector some_offset(Source& s) {
    const double length = s.eighth(-2, 2);
    return length * s.grid_vector();
}

// The face is flat or a point, or an edge is a point, all the time or (momentarily) at the time of contact only.
Pair degenerate(Source& s, bool momentarily, bool points_only) {
    const double t = s.chance(0.2) ? s.integer(0, 1) : s.inner_time();
    const Vector at = s.grid_vector(), u = s.grid_vector();
    const double a = s.eighth(0, 8);
    Points x, v = s.four([&] { return s.grid_vector(); });
    const bool to_point = points_only || s.chance(0.4);
    if (s.vertex_face()) {
        const double far = to_point ? 0.0 : s.eighth(-8, 8), near = to_point ? 0.0 : 1.0;
        x = {at, at - (a * near) * u, at + ((1.0 - a) * near) * u, at + far * u};
    } else {
        x = {at, at, at - a * u, at + (1.0 - a) * u};
        if (to_point) x[2] = x[3] = at;
        if (momentarily && s.chance(0.5)) x[1] = at + s.eighth(-8, 8) * u;  // parallel edges, overlapping
    }
    if (!momentarily) {  // keep the shape: flat faces and points move as such
        if (s.vertex_face()) {
            const double share = s.eighth(0, 8);
            v[2] = v[1] + share * u;
            v[3] = v[1];
            if (to_point) v[2] = v[1];
        } else {
            v[1] = v[0];
            if (to_point) v[3] = v[2];
        }
    }
    if (s.chance(0.3)) x[0] = x[0] + some_offset(s);  // and miss
    if (!momentarily && !s.vertex_face()) x[1] = x[0];
    return moving(x, v, t);
}

Pair resting(Source& s) {
    const Touch t = s.exact_touch(s.chance(0.5) ? Where::interior : Where::boundary);
    Points x = t.x;
    if (s.chance(0.4)) x[0] = x[0] + some_offset(s);
    const Vector drift = s.chance(0.5) ? Vector{} : s.grid_vector();
    const Pair pair = moving(x, {drift, drift, drift, drift}, 0.0);
    return s.chance(0.8) ? pair : nudged(s, pair);
}

// Parallel edges that slide along, toward or past each other; a vertex that slides in, or parallel to, the face.
Pair parallel_slide(Source& s) {
    const Vector drift = s.grid_vector();
    if (s.vertex_face()) {
        const Touch t = s.exact_touch(s.chance(0.5) ? Where::interior : Where::boundary);
        Points x = t.x;
        if (s.chance(0.3)) x[0] = x[0] + some_offset(s);
        const Vector sliding = s.in_plane(t);
        return moving(x, {drift + sliding, drift, drift, drift}, s.eighth(0, 8));
    }
    const Vector u = s.grid_vector(), offset = s.chance(0.7) ? Vector{} : s.grid_vector();
    const Vector x0 = s.grid_vector(), x2 = x0 + s.eighth(-16, 16) * u + offset;
    const Points x{x0, x0 + u, x2, x2 + s.eighth(-8, 8) * u};
    const Vector sliding = s.eighth(-24, 24) * u, approach = s.chance(0.6) ? Vector{} : s.grid_vector();
    return moving(x, {drift, drift, drift + sliding + approach, drift + sliding + approach}, s.eighth(0, 8));
}

// One primitive moves as a whole against the other one: the cubic is linear.
Pair parallel_velocity(Source& s) {
    const Vector v = s.grid_vector(), w = s.grid_vector();
    const Points x = s.chance(0.6) ? s.exact_touch(s.chance(0.7) ? Where::interior : Where::boundary).x
                                   : s.four([&] { return s.grid_vector(); });
    return moving(x, {v, s.vertex_face() ? w : v, w, w}, s.eighth(0, 8));
}

Pair scale(Source& s) {
    const Pair pair = ordinary(s);
    return scaled(pair, s.size(-8, 8));
}

Pair common_velocity(Source& s) {
    Pair pair = ordinary(s);
    const double speed = s.size(0, s.single() ? 2 : 5);
    const Vector drift = speed * s.uniform_vector();
    for (std::size_t i = 4; i < 8; ++i) pair[i] = pair[i] + drift;
    return pair;
}

Pair big_offset(Source& s) {
    const Pair pair = ordinary(s);
    const double distance = s.size(2, s.single() ? 4 : 9);
    const Vector offset = distance * s.uniform_vector();
    return map(pair, [&](double x, std::size_t axis) { return x + offset[axis]; });
}

Pair anisotropic(Source& s) {
    const Pair pair = ordinary(s);
    const Vector size{s.size(-8, 8), s.size(-8, 8), s.size(-8, 8)};
    return map(pair, [&](double x, std::size_t axis) { return size[axis] * x; });
}

// Products of three lengths overflow or underflow, single coordinates may be subnormal.
Pair extreme_scale(Source& s) {
    const double half_exponent = s.chance(0.5) ? (s.single() ? s.uniform(-22, -6) : s.uniform(-160, -55))
                                               : (s.single() ? s.uniform(6, 18.5) : s.uniform(55, 153.5));
    // In two steps: a subnormal factor would have lost its bits before the product does.
    const double half = s.size(half_exponent, half_exponent);
    return scaled(scaled(ordinary(s), half), half);
}

Pair mixed_exponent(Source& s) {
    const double range = s.chance(0.7) ? 8 : s.single() ? 30 : 290;
    return map(ordinary(s), [&](double x, std::size_t) {
        const double largest = s.chance(0.1) ? range : 0;
        return s.size(-range, largest) * x;
    });
}

// Cloth in motion: cells of 0.1, steps of about half of one, layers a fraction of that apart.
Pair cloth(Source& s) {
    Points x = s.rounded_touch(Where::interior).x;
    for (Vector& point : x) {
        point = 0.1 * point + 0.01 * s.uniform_vector();
        point[2] *= 0.2;
    }
    const Vector drift = 0.05 * s.uniform_vector();
    const Points v = s.four([&] { return drift + 0.02 * s.uniform_vector(); });
    return map(moving(x, v, s.unit()), [](double c, std::size_t axis) { return axis == 2 ? c + 1.0 : c; });
}

// The cubic vanishes identically, in general position otherwise: motion in a fixed tilted plane; in a turning one;
// two points that are one.
Pair zero_cubic(Source& s) {
    switch (s.integer(0, 2)) {
        case 0: return planar(s);
        case 1: {  // x_i(t) = o(t) + y_i e(t) + z_i f(t)
            const std::array<Vector, 2> o{s.grid_vector(), s.grid_vector()}, e{s.grid_vector(), s.grid_vector()},
                f{s.grid_vector(), s.grid_vector()};
            Pair pair;
            for (std::size_t i = 0; i < 4; ++i) {
                const double y = s.eighth(-8, 8), z = s.eighth(-8, 8);
                for (std::size_t end = 0; end < 2; ++end) pair[i + 4 * end] = o[end] + y * e[end] + z * f[end];
            }
            return pair;
        }
        default: {
            Pair pair = exact_contact(s, Where::boundary, s.inner_time());
            const auto from = static_cast<std::size_t>(s.integer(0, 2));
            pair[from + 1] = pair[from];
            pair[from + 5] = pair[from + 4];
            return pair;
        }
    }
}

// A vertex, or end point, meets a corner at t = 0, 1/2 or 1 exactly, with all bits of all coordinates in use: sizes
// 0.001 .. 1000 that are no powers of two. At 1/2: the two points trade places.
Pair corner(Source& s) {
    Pair pair = from_anywhere_to_anywhere(s, [&] { return s.uniform_vector(); });
    pair = scaled(pair, s.size(-3, 3));
    const auto i = static_cast<std::size_t>(s.vertex_face() ? 0 : s.integer(0, 1));
    const auto j = static_cast<std::size_t>(s.integer(s.vertex_face() ? 1 : 2, 3));
    switch (s.integer(0, 2)) {
        case 0: pair[i] = pair[j]; break;
        case 1: pair[i] = pair[j + 4], pair[i + 4] = pair[j]; break;
        default: pair[i + 4] = pair[j + 4];
    }
    return s.chance(0.8) ? pair : nudged(s, pair);
}

struct Family {
    const char* name;
    Pair (*make)(Source&);
};

constexpr Family all_families[] = {
    {"uniform", uniform},
    {"scale", scale},
    {"big_offset", big_offset},
    {"aniso", anisotropic},
    {"grazing", grazing},
    {"grazing_exact", grazing_exact},
    {"boundary", [](Source& s) { return exact_contact(s, Where::boundary, s.inner_time()); }},
    {"near_boundary", [](Source& s) { return nudged(s, rounded_contact(s, Where::boundary)); }},
    {"near_interior", [](Source& s) { return nudged(s, exact_contact(s, Where::interior, s.inner_time())); }},
    {"t0_contact", [](Source& s) { return at_end_point(s, 0.0); }},
    {"t1_contact", [](Source& s) { return at_end_point(s, 1.0); }},
    {"coplanar_grid", coplanar_grid},
    {"coplanar_map", coplanar_map},
    {"collinear", collinear},
    {"degenerate", [](Source& s) { return degenerate(s, false, false); }},
    {"momentary_degenerate", [](Source& s) { return degenerate(s, true, false); }},
    {"resting", resting},
    {"parallel_slide", parallel_slide},
    {"parallel_vel", parallel_velocity},
    {"common_velocity", common_velocity},
    {"pointpoint", [](Source& s) { return degenerate(s, false, true); }},
    {"tinygrid", [](Source& s) { return s.chance(0.5) ? grid(s, -2, 2) : grid(s, -1, 1); }},
    {"binarygrid", [](Source& s) { return grid(s, 0, 1); }},
    {"extreme_scale", extreme_scale},
    {"mixed_exponent", mixed_exponent},
    {"simcloth", cloth},
    {"zero_cubic", zero_cubic},
    {"corner", corner},
};

constexpr std::string_view single_prefix = "f32_";

}  // namespace

const std::vector<std::string>& families() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const Family& family : all_families) result.emplace_back(family.name);
        for (const Family& family : all_families) result.push_back(std::string(single_prefix) + family.name);
        return result;
    }();
    return names;
}

void generate(const std::string& family, Kind kind, std::uint64_t seed, std::size_t n, std::vector<Pair>& out) {
    const bool single = family.starts_with(single_prefix);
    const std::string base = single ? family.substr(single_prefix.size()) : family;
    const auto* const found = std::ranges::find_if(all_families, [&](const Family& f) { return base == f.name; });
    if (found == std::end(all_families)) throw std::invalid_argument("generate: no family of hard pairs: " + family);

    Source source(kind, single, seed);
    out.clear();
    out.reserve(n);
    while (out.size() < n) {
        // Families that need exact coordinates choose them such that this rounding changes nothing.
        out.push_back(map(found->make(source), [&](double x, std::size_t) {
            return single ? static_cast<double>(static_cast<float>(x)) : x;
        }));
    }
}

std::vector<Pair> mixed_pairs(Kind kind, std::uint64_t seed, std::size_t per_family) {
    std::vector<Pair> in_order, of_family;
    for (const std::string& family : families()) {
        generate(family, kind, seed, per_family, of_family);
        in_order.insert(in_order.end(), of_family.begin(), of_family.end());
    }
    std::vector<Pair> mixed(in_order.size());
    std::size_t stride = 7919;  // a prime; where it divides the size, the next odd number that does not
    while (in_order.size() % stride == 0) stride += 2;
    for (std::size_t i = 0; i < in_order.size(); ++i) mixed[(i * stride) % in_order.size()] = in_order[i];
    return mixed;
}

}  // namespace fastccd::testing
