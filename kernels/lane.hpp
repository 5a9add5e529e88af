// What a lane type must provide, and the lane type `double`.
//
// Every kernel is one template on a lane type L: `double` (one pair) or `xsimd::batch<double, A>`
// (several pairs side by side); the certificates also `xsimd::batch<float, A>`, twice as many. Only + - * / and square root, all
// correctly rounded by IEEE 754, comparisons, operations on bits of the sign and the exponent, and the min / max below may decide a
// result: that is what makes the results the same bits for every L. Nothing is contracted (the build switches that off): no product
// loses its rounding.
//
// All kernels live in a namespace of their own per instruction set: two translation units compiled
// with different instruction sets must never emit the same inline function, because the linker
// would keep one copy for both.
#pragma once

#include <cstddef>
#include <cstdint>

#include <fastccd/pair_view.hpp>
#include <grid_box.hpp>

#ifndef FASTCCD_KERNEL_NAMESPACE
#define FASTCCD_KERNEL_NAMESPACE portable
#endif

// Compilers left to themselves call too many of these functions. Whoever compiles kernels for their logic alone may define these two otherwise.
#ifndef FASTCCD_INLINE
#define FASTCCD_INLINE inline __attribute__((always_inline))
#define FASTCCD_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Comparison result of the lane type `double`.
struct BoolMask {
    bool value;

    friend FASTCCD_INLINE BoolMask operator&(BoolMask a, BoolMask b) { return {a.value && b.value}; }
    friend FASTCCD_INLINE BoolMask operator|(BoolMask a, BoolMask b) { return {a.value || b.value}; }
    friend FASTCCD_INLINE BoolMask operator!(BoolMask a) { return {!a.value}; }
};

/// Operations on a lane type that are not operators. Specialised for each lane type.
template <class L>
struct Lane;

template <>
struct Lane<double> {
    using Mask = BoolMask;
    static constexpr unsigned width = 1;
    static constexpr bool is_single = false;
    /// The lane type that pairs are screened in: of single precision where that makes lanes, two batches of this one at a time.
    using Screening = double;
    /// Whether groups of which few pairs go on may be screened in either precision, by Preferences.
    static constexpr bool screens_scenes_in_either = false;
    template <unsigned part>
    static FASTCCD_INLINE double widened(double x)
    {
        return x;
    }

    static FASTCCD_INLINE double broadcast(double x) { return x; }
    static FASTCCD_INLINE double load(const double* p) { return *p; }
    static FASTCCD_INLINE double load(const float* p) { return *p; }
    static FASTCCD_INLINE void store(double* p, double x) { *p = x; }
    /// Coordinates of pairs from anywhere in blocks of the native layout, doubles or floats: pairs[i] is where number 0 of the pair in lane i
    /// lies. Every block begins a multiple of 8 numbers before or after `blocks`.
    template <class Number>
    class Collector {
    public:
        FASTCCD_INLINE Collector(const Number* /*blocks*/, const void* const* pairs) : pair_{static_cast<const Number*>(pairs[0])} {}
        FASTCCD_INLINE double operator()(int c) const { return pair_[static_cast<std::size_t>(c) * block_pairs]; }

    private:
        const Number* pair_;
    };
    /// 0, 1, 2, ... : the number of each lane.
    static FASTCCD_INLINE double lane_number() { return 0.0; }

    // MINPD's and MAXPD's rule, in every lane type: the second operand if either is NaN or both are zero.
    static FASTCCD_INLINE double min(double a, double b) { return a < b ? a : b; }
    static FASTCCD_INLINE double max(double a, double b) { return a > b ? a : b; }
    static FASTCCD_INLINE double abs(double a) { return __builtin_fabs(a); }
    static FASTCCD_INLINE double negated(double a) { return -a; }
    static FASTCCD_INLINE double times_sign(double a, double b) { return __builtin_signbit(b) ? -a : a; }
    static FASTCCD_INLINE double power_of_two(double a)
    {
        return __builtin_bit_cast(double, __builtin_bit_cast(std::uint64_t, a) & __builtin_bit_cast(std::uint64_t, __builtin_inf()));
    }
    /// a - b, on whichever units have less to do elsewhere.
    static FASTCCD_INLINE double difference(double a, double b) { return a - b; }
    static FASTCCD_INLINE double sqrt(double a) { return __builtin_sqrt(a); }
    static FASTCCD_INLINE double select(Mask m, double yes, double no) { return m.value ? yes : no; }

    static FASTCCD_INLINE Mask less(double a, double b) { return {a < b}; }
    static FASTCCD_INLINE Mask less_equal(double a, double b) { return {a <= b}; }

    /// Bit i is lane i.
    static FASTCCD_INLINE unsigned bits(Mask m) { return m.value ? 1u : 0u; }
    /// Writes the lanes whose bit is set one after another to p; may write `width` elements.
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, double x)
    {
        if (bits != 0) *p = x;
    }

    /// Columns of records that transpose() takes at a time.
    static constexpr int transposed_columns = 1;
    /// Lane i of columns[k] becomes records[i][first + k], of doubles or floats.
    template <class Number>
    static FASTCCD_INLINE void transpose(const Number* const* records, int first, double* columns)
    {
        columns[0] = records[0][first];
    }

    /// What the box of the pair's first primitive compares with: highest x y z, 0, minus the lowest x y z, 0, all moved
    /// outwards by `separation`, at both ends.
    struct FirstBox {
        std::int32_t start[8], end[8];
    };
    static FASTCCD_INLINE FirstBox first_box(const GridBox& box, const std::int16_t* separation)
    {
        FirstBox first;
        for (int k = 0; k < 8; ++k) {
            first.start[k] = separation[k] - box.start[k ^ 4];
            first.end[k] = separation[k] - box.end[k ^ 4];
        }
        return first;
    }
    /// Whether the boxes are apart along an axis, in the same order at both ends (grid_box.hpp).
    static FASTCCD_INLINE bool apart(const FirstBox& first, const GridBox& second)
    {
        bool any = false;
        for (int k = 0; k < 8; ++k) any |= (first.start[k] < second.start[k]) & (first.end[k] < second.end[k]);
        return any;
    }
};

template <class L>
using LaneMask = typename Lane<L>::Mask;

template <class L>
FASTCCD_INLINE L broadcast(double x)
{
    return Lane<L>::broadcast(x);
}
template <class L>
FASTCCD_INLINE L min(L a, L b)
{
    return Lane<L>::min(a, b);
}
template <class L>
FASTCCD_INLINE L max(L a, L b)
{
    return Lane<L>::max(a, b);
}
template <class L>
FASTCCD_INLINE L min(L a, L b, L c)
{
    return Lane<L>::min(Lane<L>::min(a, b), c);
}
template <class L>
FASTCCD_INLINE L max(L a, L b, L c)
{
    return Lane<L>::max(Lane<L>::max(a, b), c);
}
template <class L>
FASTCCD_INLINE L abs(L a)
{
    return Lane<L>::abs(a);
}
/// -a, by its sign bit: most processors have more units for that than for sums. Not `neg`: xsimd has one, which would be found
/// first, and it subtracts from 0.
template <class L>
FASTCCD_INLINE L negated(L a)
{
    return Lane<L>::negated(a);
}
/// a with its sign bit changed where b has one.
template <class L>
FASTCCD_INLINE L times_sign(L a, L b)
{
    return Lane<L>::times_sign(a, b);
}
/// The largest power of two that is not above |a|, which is to be finite and normal; 0 for 0.
template <class L>
FASTCCD_INLINE L power_of_two(L a)
{
    return Lane<L>::power_of_two(a);
}
template <class L>
FASTCCD_INLINE L sqrt(L a)
{
    return Lane<L>::sqrt(a);
}
template <class L>
FASTCCD_INLINE L select(LaneMask<L> m, L yes, L no)
{
    return Lane<L>::select(m, yes, no);
}
/// a < b in each lane; false if either is NaN.
template <class L>
FASTCCD_INLINE LaneMask<L> less(L a, L b)
{
    return Lane<L>::less(a, b);
}
template <class L>
FASTCCD_INLINE LaneMask<L> less_equal(L a, L b)
{
    return Lane<L>::less_equal(a, b);
}
template <class L>
FASTCCD_INLINE LaneMask<L> no_lanes()
{
    return less(broadcast<L>(0.0), broadcast<L>(0.0));
}
template <class L>
FASTCCD_INLINE LaneMask<L> all_lanes()
{
    return less_equal(broadcast<L>(0.0), broadcast<L>(0.0));
}

/// Three components, one per axis.
template <class L>
struct Vector3 {
    L x, y, z;
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
