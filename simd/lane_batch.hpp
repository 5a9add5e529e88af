// The lane types xsimd::batch<double, A> and, for screening, xsimd::batch<float, A>, of the instruction sets that this is compiled for.
#pragma once

#include <batch_traits.hpp>

#if XSIMD_WITH_SSE2
#include <batch_sse2.hpp>
#endif
#if XSIMD_WITH_AVX2
#include <batch_avx2.hpp>
#endif
#if XSIMD_WITH_AVX512BW
#include <batch_avx512.hpp>
#endif
#if XSIMD_WITH_NEON64
#include <batch_neon.hpp>
#endif

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// What certificates are computed with, in either precision.
template <class T, class A>
struct BatchArithmetic {
    using Batch = xsimd::batch<T, A>;
    using Mask = xsimd::batch_bool<T, A>;
    using Traits = BatchTraits<A>;
    static constexpr unsigned width = Batch::size;
    static constexpr bool is_single = sizeof(T) == sizeof(float);

    static FASTCCD_INLINE Batch broadcast(double x) { return Batch(static_cast<T>(x)); }

    static FASTCCD_INLINE Batch min(Batch a, Batch b) { return Traits::min(a, b); }
    static FASTCCD_INLINE Batch max(Batch a, Batch b) { return Traits::max(a, b); }
    static FASTCCD_INLINE Batch abs(Batch a) { return xsimd::abs(a); }
    static FASTCCD_INLINE Batch negated(Batch a) { return a ^ broadcast(-0.0); }
    static FASTCCD_INLINE Batch times_sign(Batch a, Batch b) { return a ^ (b & broadcast(-0.0)); }
    static FASTCCD_INLINE Batch power_of_two(Batch a) { return a & broadcast(__builtin_inf()); }
    static FASTCCD_INLINE Batch select(Mask m, Batch yes, Batch no) { return xsimd::select(m, yes, no); }

    static FASTCCD_INLINE Mask less(Batch a, Batch b) { return a < b; }
    static FASTCCD_INLINE Mask less_equal(Batch a, Batch b) { return a <= b; }
    static FASTCCD_INLINE unsigned bits(Mask m) { return Traits::bits(m.data); }

    static FASTCCD_INLINE Batch difference(Batch a, Batch b) { return Traits::difference(a, b); }
};

template <class A>
struct Lane<xsimd::batch<float, A>> : BatchArithmetic<float, A> {
    using Batch = xsimd::batch<float, A>;
    using Traits = BatchTraits<A>;

    static FASTCCD_INLINE Batch load(const float* p) { return Batch::load_unaligned(p); }
    /// Half of the lanes from each. Only of more than block_pairs lanes.
    static FASTCCD_INLINE Batch load_halves(const float* low, const float* high) { return Traits::load_halves(low, high); }
    static constexpr int transposed_columns = 4;
    static FASTCCD_INLINE void transpose(const float* const* records, int first, Batch* columns)
    {
        Traits::transpose_singles(records, first, columns);
    }
};

template <class A>
struct Lane<xsimd::batch<double, A>> : BatchArithmetic<double, A> {
    using Batch = xsimd::batch<double, A>;
    using Traits = BatchTraits<A>;

    using Screening = xsimd::batch<float, A>;
    static constexpr bool screens_scenes_in_either = Traits::screens_scenes_in_either;
    /// Both rounded to single precision, `low` in the first lanes and `high` behind it; widened() gives back either part.
    static FASTCCD_INLINE Screening narrowed(Batch low, Batch high) { return Traits::narrowed(low, high); }
    template <unsigned part>
    static FASTCCD_INLINE Batch widened(Screening x)
    {
        return part == 0 ? Traits::widened_low(x) : Traits::widened_high(x);
    }

    static FASTCCD_INLINE Batch load(const double* p) { return Batch::load_unaligned(p); }
    static FASTCCD_INLINE Batch load(const float* p) { return Traits::load(p); }
    static FASTCCD_INLINE void store(double* p, Batch x) { x.store_unaligned(p); }
    template <class Number>
    using Collector = typename Traits::template Collector<Number>;
    static FASTCCD_INLINE Batch lane_number()
    {
        alignas(64) static constexpr double numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        return Batch::load_unaligned(numbers);
    }

    static FASTCCD_INLINE Batch sqrt(Batch a) { return xsimd::sqrt(a); }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, Batch x) { Traits::compress_store(p, bits, x); }
    /// Whether there is a Joiner{bits}: for `bits` of two batches, not more than one holds, joiner(low, high) are those lanes, in order,
    /// and any others behind them. With batches of two lanes, too often more are wanted.
    static constexpr bool can_join = requires { typename Traits::Joiner; };
    template <class T = Traits>
    using Joiner = typename T::Joiner;

    static constexpr int transposed_columns = Traits::transposed_columns;
    template <class Number>
    static FASTCCD_INLINE void transpose(const Number* const* records, int first, Batch* columns)
    {
        Traits::transpose(records, first, columns);
    }

    using FirstBox = typename Traits::FirstBox;
    static FASTCCD_INLINE FirstBox first_box(const GridBox& box, const std::int16_t* separation) { return Traits::first_box(box, separation); }
    static FASTCCD_INLINE bool apart(const FirstBox& first, const GridBox& second) { return Traits::apart(first, second); }
};

// Found by argument, xsimd::min and max would be preferred to the templates of lane.hpp, and on NEON they propagate NaN. These are
// preferred to both. To be included before the kernels, which look them up where they stand.

template <class A>
FASTCCD_INLINE xsimd::batch<double, A> min(const xsimd::batch<double, A>& a, const xsimd::batch<double, A>& b)
{
    return Lane<xsimd::batch<double, A>>::min(a, b);
}
template <class A>
FASTCCD_INLINE xsimd::batch<float, A> min(const xsimd::batch<float, A>& a, const xsimd::batch<float, A>& b)
{
    return Lane<xsimd::batch<float, A>>::min(a, b);
}
template <class A>
FASTCCD_INLINE xsimd::batch<double, A> max(const xsimd::batch<double, A>& a, const xsimd::batch<double, A>& b)
{
    return Lane<xsimd::batch<double, A>>::max(a, b);
}
template <class A>
FASTCCD_INLINE xsimd::batch<float, A> max(const xsimd::batch<float, A>& a, const xsimd::batch<float, A>& b)
{
    return Lane<xsimd::batch<float, A>>::max(a, b);
}

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
