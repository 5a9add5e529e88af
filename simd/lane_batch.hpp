// The lane type xsimd::batch<double, A>.
//
// xsimd gives loads, arithmetic, comparisons and selection. What it lacks in version 8.1 (bits of a mask,
// storing only some lanes, min / max with MINPD's rule on NEON) is written out per architecture.
#pragma once

#include <xsimd/xsimd.hpp>

#include <lane.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class A>
struct BatchTraits;

#if XSIMD_WITH_SSE2
template <>
struct BatchTraits<xsimd::sse2> {
    static FASTCCD_INLINE unsigned bits(__m128d m) { return static_cast<unsigned>(_mm_movemask_pd(m)); }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, __m128d x)
    {
        _mm_storeu_pd(p, bits == 2 ? _mm_unpackhi_pd(x, x) : x);
    }
    static FASTCCD_INLINE __m128d min(__m128d a, __m128d b) { return _mm_min_pd(a, b); }
    static FASTCCD_INLINE __m128d max(__m128d a, __m128d b) { return _mm_max_pd(a, b); }
};
#endif

#if XSIMD_WITH_AVX2
/// Row m moves the doubles whose bit is set in m to the front (as pairs of 32-bit lanes).
alignas(32) inline constexpr int compress_permutation[16][8] = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {2, 3, 0, 1, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {4, 5, 0, 1, 2, 3, 6, 7}, {0, 1, 4, 5, 2, 3, 6, 7}, {2, 3, 4, 5, 0, 1, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {6, 7, 0, 1, 2, 3, 4, 5}, {0, 1, 6, 7, 2, 3, 4, 5}, {2, 3, 6, 7, 0, 1, 4, 5}, {0, 1, 2, 3, 6, 7, 4, 5},
    {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 4, 5, 6, 7, 2, 3}, {2, 3, 4, 5, 6, 7, 0, 1}, {0, 1, 2, 3, 4, 5, 6, 7}};

template <>
struct BatchTraits<xsimd::avx2> {
    static FASTCCD_INLINE unsigned bits(__m256d m) { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, __m256d x)
    {
        const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_permutation[bits]));
        _mm256_storeu_pd(p, _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(x), order)));
    }
    static FASTCCD_INLINE __m256d min(__m256d a, __m256d b) { return _mm256_min_pd(a, b); }
    static FASTCCD_INLINE __m256d max(__m256d a, __m256d b) { return _mm256_max_pd(a, b); }
};
#endif

#if XSIMD_WITH_AVX512BW
template <>
struct BatchTraits<xsimd::avx512bw> {
    static FASTCCD_INLINE unsigned bits(__mmask8 m) { return m; }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, __m512d x)
    {
        // Compress in a register, then store all of it: storing through a mask is microcoded on some machines.
        _mm512_storeu_pd(p, _mm512_maskz_compress_pd(static_cast<__mmask8>(bits), x));
    }
    static FASTCCD_INLINE __m512d min(__m512d a, __m512d b) { return _mm512_min_pd(a, b); }
    static FASTCCD_INLINE __m512d max(__m512d a, __m512d b) { return _mm512_max_pd(a, b); }
};
#endif

#if XSIMD_WITH_NEON64
template <>
struct BatchTraits<xsimd::neon64> {
    static FASTCCD_INLINE unsigned bits(uint64x2_t m)
    {
        return static_cast<unsigned>((vgetq_lane_u64(m, 0) & 1) | (vgetq_lane_u64(m, 1) & 2));
    }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, float64x2_t x)
    {
        vst1q_f64(p, bits == 2 ? vdupq_laneq_f64(x, 1) : x);
    }
    // vminq / vmaxq propagate NaN and order the zeros; MINPD's rule is a selection.
    static FASTCCD_INLINE float64x2_t min(float64x2_t a, float64x2_t b) { return vbslq_f64(vcltq_f64(a, b), a, b); }
    static FASTCCD_INLINE float64x2_t max(float64x2_t a, float64x2_t b) { return vbslq_f64(vcgtq_f64(a, b), a, b); }
};
#endif

template <class A>
struct Lane<xsimd::batch<double, A>> {
    using Batch = xsimd::batch<double, A>;
    using Mask = xsimd::batch_bool<double, A>;
    using Traits = BatchTraits<A>;
    static constexpr unsigned width = Batch::size;

    static FASTCCD_INLINE Batch broadcast(double x) { return Batch(x); }
    static FASTCCD_INLINE Batch load(const double* p) { return Batch::load_unaligned(p); }
    static FASTCCD_INLINE void store(double* p, Batch x) { x.store_unaligned(p); }
    static FASTCCD_INLINE Batch lane_number()
    {
        alignas(64) static constexpr double numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        return Batch::load_unaligned(numbers);
    }

    static FASTCCD_INLINE Batch min(Batch a, Batch b) { return Traits::min(a, b); }
    static FASTCCD_INLINE Batch max(Batch a, Batch b) { return Traits::max(a, b); }
    static FASTCCD_INLINE Batch abs(Batch a) { return xsimd::abs(a); }
    static FASTCCD_INLINE Batch sqrt(Batch a) { return xsimd::sqrt(a); }
    static FASTCCD_INLINE Batch select(Mask m, Batch yes, Batch no) { return xsimd::select(m, yes, no); }

    static FASTCCD_INLINE Mask less(Batch a, Batch b) { return a < b; }
    static FASTCCD_INLINE Mask less_equal(Batch a, Batch b) { return a <= b; }

    static FASTCCD_INLINE unsigned bits(Mask m) { return Traits::bits(m.data); }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, Batch x) { Traits::compress_store(p, bits, x); }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
