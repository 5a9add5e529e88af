// Contact in exact integers. The differences between points of the two primitives form a triangle (vertex-face) or a
// parallelogram, cut along a diagonal into two triangles (edge-edge): contact is the origin in one of these, also
// where they are flat. For a moving triangle A B C that is a matter of the signs of
//
//     the normals A x B, B x C, C x A and their sum N, and the products A . B, B . C, C . A,
//
// at times when the origin is in its plane: A . (B x C) = 0. So contact begins at a root of that cubic; or, where it is
// the zero polynomial, at time 0 or at a root of one of those quadratics, between which no sign changes.
#include <exact_contact.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <binary_form.hpp>

namespace fastccd::scalar {

namespace {

/// A point that moves linearly: a linear form for each axis.
using MovingPoint = std::array<BinaryForm, 3>;

MovingPoint operator-(const MovingPoint& a, const MovingPoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

BinaryForm dot(const MovingPoint& a, const MovingPoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

MovingPoint cross(const MovingPoint& a, const MovingPoint& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A finite double is mantissa 2^exponent.
struct Binary {
    mpz_class mantissa;
    int exponent;

    explicit Binary(double x)
    {
        const double fraction = std::frexp(x, &exponent);
        mantissa = std::ldexp(fraction, 53);
        exponent -= 53;
    }
};

/// The points at u = 0 and at u = 1, t = u t_max, times one power of two per axis: contact does not change under
/// stretching along an axis.
std::array<MovingPoint, 4> integer_motion(const double* coordinates, double t_max)
{
    const Binary end{t_max};  // in (0, 1], so the exponent is negative
    std::array<MovingPoint, 4> points;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        int lowest = 0;
        for (std::size_t k = 0; k < 8; ++k)
            if (const double x = coordinates[3 * k + axis]; x != 0.0) lowest = std::min(lowest, Binary{x}.exponent);
        const auto integer = [&](std::size_t k) {
            const double x = coordinates[3 * k + axis];
            const Binary b{x};
            return x == 0.0 ? mpz_class{0} : mpz_class{b.mantissa << static_cast<unsigned>(b.exponent - lowest)};
        };
        for (std::size_t point = 0; point < 4; ++point) {
            const mpz_class first = integer(point), last = integer(point + 4);
            const mpz_class start = first << static_cast<unsigned>(-end.exponent);
            points[point][axis] = {{start, start + end.mantissa * (last - first)}};
        }
    }
    return points;
}

/// A triangle of difference vectors; contact is the origin in it.
class MovingTriangle {
public:
    MovingTriangle(const MovingPoint& a, const MovingPoint& b, const MovingPoint& c)
        : volume{dot(a, cross(b, c))}, normals_{cross(a, b), cross(b, c), cross(c, a)}, products_{dot(a, b), dot(b, c), dot(c, a)}
    {
        for (std::size_t axis = 0; axis < 3; ++axis) sum_[axis] = normals_[0][axis] + normals_[1][axis] + normals_[2][axis];
    }

    /// Whether the origin, in the triangle's plane at this time, is in the triangle.
    [[nodiscard]] bool holds_origin(AlgebraicTime& time) const
    {
        // In a plane through the origin all four normals are parallel, and the components of the first three, divided by
        // that of the sum, are the origin's barycentric coordinates.
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int side = time.sign(sum_[axis]);
            if (side != 0)
                return std::ranges::all_of(normals_, [&](const auto& n) { return time.sign(n[axis]) * side >= 0; });
        }
        // A flat triangle is the union of its sides. The origin is on the side A B if A and B are parallel and do not point
        // the same way.
        for (std::size_t side = 0; side < 3; ++side) {
            const MovingPoint& n = normals_[side];
            if (time.sign(n[0]) == 0 && time.sign(n[1]) == 0 && time.sign(n[2]) == 0 && time.sign(products_[side]) <= 0)
                return true;
        }
        return false;
    }

    BinaryForm volume;

    /// Everything whose sign matters, where the volume is always zero.
    template <class Visit>
    void for_each_quadratic(Visit visit) const
    {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (const MovingPoint& n : normals_) visit(n[axis]);
            visit(sum_[axis]);
        }
        for (const BinaryForm& product : products_) visit(product);
    }

private:
    std::array<MovingPoint, 3> normals_;
    std::array<BinaryForm, 3> products_;
    MovingPoint sum_;
};

std::vector<MovingTriangle> difference_triangles(PairKind kind, const std::array<MovingPoint, 4>& x)
{
    if (kind == PairKind::vertex_face) return {{x[1] - x[0], x[2] - x[0], x[3] - x[0]}};
    return {{x[2] - x[0], x[3] - x[0], x[3] - x[1]}, {x[2] - x[0], x[2] - x[1], x[3] - x[1]}};
}

}  // namespace

bool exact_contact_available() noexcept { return true; }

ExactContact exact_contact(PairKind kind, const double* coordinates, const SearchParameters& parameters)
{
    const std::vector<MovingTriangle> triangles = difference_triangles(kind, integer_motion(coordinates, parameters.t_max));
    const auto depth = static_cast<unsigned>(std::ilogb(parameters.leaf_count));
    std::optional<double> earliest;
    const auto lower_bound = [&](AlgebraicTime& time) {
        const mpz_class leaf = time.floor_times_two_to(depth);
        if (leaf != 0 || time.is_start()) return leaf.get_d() * parameters.leaf_width;
        constexpr unsigned finest = 1074;  // the least double is 2^-1074
        for (unsigned finer = depth + 1; finer <= finest; ++finer)
            if (time.floor_times_two_to(finer) != 0) return std::ldexp(1.0, -static_cast<int>(finer));
        return 0.0;
    };
    const auto test = [&](AlgebraicTime& time) {
        const bool contact = std::ranges::any_of(triangles, [&](const auto& triangle) { return triangle.holds_origin(time); });
        if (!contact) return false;
        const double bound = lower_bound(time);
        if (!earliest || bound < *earliest) earliest = bound;
        return true;
    };

    // The volume is the same for both triangles of an edge-edge pair but for its sign. Pairs that rest on one another have contact
    // at time 0, and none of the other roots need be told apart.
    const BinaryForm& volume = triangles[0].volume;
    if (AlgebraicTime start = AlgebraicTime::rational({0, 0}); volume.at_start() == 0 && test(start)) return {true, 0.0};
    if (!volume.is_zero()) {
        for (AlgebraicTime& time : roots(volume))
            if (test(time)) break;
    } else {
        for (const MovingTriangle& triangle : triangles)
            triangle.for_each_quadratic([&](const BinaryForm& form) {
                if (form.is_zero()) return;
                for (AlgebraicTime& time : roots(form))
                    if (test(time)) break;
            });
    }
    return {earliest.has_value(), earliest.value_or(0.0)};
}

}  // namespace fastccd::scalar
