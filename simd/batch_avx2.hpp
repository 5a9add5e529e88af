// Batches of four doubles or eight floats, in AVX2; its comparison of boxes is also that of AVX-512.
#pragma once

#include <batch_sse2.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Row m moves the doubles whose bit is set in m to the front (as pairs of 32-bit lanes).
alignas(32) inline constexpr int compress_permutation[16][8] = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {2, 3, 0, 1, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {4, 5, 0, 1, 2, 3, 6, 7}, {0, 1, 4, 5, 2, 3, 6, 7}, {2, 3, 4, 5, 0, 1, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {6, 7, 0, 1, 2, 3, 4, 5}, {0, 1, 6, 7, 2, 3, 4, 5}, {2, 3, 6, 7, 0, 1, 4, 5}, {0, 1, 2, 3, 6, 7, 4, 5},
    {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 4, 5, 6, 7, 2, 3}, {2, 3, 4, 5, 6, 7, 0, 1}, {0, 1, 2, 3, 4, 5, 6, 7}};

/// Boxes of the grid in registers of 256 bits, for AVX2 and AVX-512.
struct WideBoxes {
    using FirstBox = __m256i;
    static FASTCCD_INLINE __m256i first_box(const GridBox& box, const std::int16_t* separation)
    {
        const __m256i k = _mm256_broadcastsi128_si256(_mm_load_si128(reinterpret_cast<const __m128i*>(separation)));
        return _mm256_subs_epi16(k, _mm256_shuffle_epi32(load(box), 0x4e));
    }
    static FASTCCD_INLINE bool apart(__m256i first, const GridBox& second)
    {
        const auto less = static_cast<unsigned>(_mm256_movemask_epi8(_mm256_cmpgt_epi16(load(second), first)));
        return (less & less >> 16) != 0;
    }

private:
    static FASTCCD_INLINE __m256i load(const GridBox& box) { return _mm256_load_si256(reinterpret_cast<const __m256i*>(&box)); }
};

/// Four floats of a, then four of b.
FASTCCD_INLINE __m256 two_halves(const float* a, const float* b)
{
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(a)), _mm_loadu_ps(b), 1);
}

/// Lane i of columns[k] becomes records[i][first + k].
FASTCCD_INLINE void transpose_eight(const float* const* records, int first, __m256 (&columns)[4])
{
    const auto two = [&](int k) FASTCCD_INLINE_LAMBDA { return two_halves(records[k] + first, records[k + 4] + first); };
    const __m256 r0 = two(0), r1 = two(1), r2 = two(2), r3 = two(3);
    const __m256d front01 = _mm256_castps_pd(_mm256_unpacklo_ps(r0, r1)), back01 = _mm256_castps_pd(_mm256_unpackhi_ps(r0, r1));
    const __m256d front23 = _mm256_castps_pd(_mm256_unpacklo_ps(r2, r3)), back23 = _mm256_castps_pd(_mm256_unpackhi_ps(r2, r3));
    columns[0] = _mm256_castpd_ps(_mm256_unpacklo_pd(front01, front23));
    columns[1] = _mm256_castpd_ps(_mm256_unpackhi_pd(front01, front23));
    columns[2] = _mm256_castpd_ps(_mm256_unpacklo_pd(back01, back23));
    columns[3] = _mm256_castpd_ps(_mm256_unpackhi_pd(back01, back23));
}

template <>
struct BatchTraits<xsimd::avx2> : WideBoxes {
    static FASTCCD_INLINE unsigned bits(__m256d m) { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
    template <class Number>
    using Collector = CoordinateCollector<BatchTraits, Number>;
    template <class From>
    static FASTCCD_INLINE __m256d collect(From from)
    {
        return _mm256_set_pd(*from(3), *from(2), *from(1), *from(0));
    }
    static FASTCCD_INLINE __m256d load(const float* p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, __m256d x)
    {
        const __m256i order = _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_permutation[bits]));
        _mm256_storeu_pd(p, _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(x), order)));
    }
    class Joiner {
    public:
        FASTCCD_INLINE explicit Joiner(unsigned bits)
        {
            const unsigned low = bits & 15, high = bits >> 4;
            const int from_low = __builtin_popcount(low);
            // Those of the second batch come after `from_low` doubles of the first.
            alignas(64) static constexpr int behind[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7};
            const __m256i shift = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(behind + 8 - 2 * from_low));
            low_order_ = _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_permutation[low]));
            high_order_ = _mm256_permutevar8x32_epi32(
                _mm256_load_si256(reinterpret_cast<const __m256i*>(compress_permutation[high])), shift);
            is_high_ = _mm256_castsi256_pd(_mm256_cmpgt_epi64(_mm256_set_epi64x(4, 3, 2, 1), _mm256_set1_epi64x(from_low)));
        }
        FASTCCD_INLINE __m256d operator()(__m256d low, __m256d high) const
        {
            return _mm256_blendv_pd(permuted(low, low_order_), permuted(high, high_order_), is_high_);
        }

    private:
        static FASTCCD_INLINE __m256d permuted(__m256d x, __m256i order)
        {
            return _mm256_castps_pd(_mm256_permutevar8x32_ps(_mm256_castpd_ps(x), order));
        }
        __m256i low_order_, high_order_;
        __m256d is_high_;
    };
    static FASTCCD_INLINE unsigned bits(__m256 m) { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
    static constexpr bool screens_scenes_in_either = false;
    static FASTCCD_INLINE __m256 min(__m256 a, __m256 b) { return _mm256_min_ps(a, b); }
    static FASTCCD_INLINE __m256 max(__m256 a, __m256 b) { return _mm256_max_ps(a, b); }
    static FASTCCD_INLINE __m256d widened_low(__m256 x) { return _mm256_cvtps_pd(_mm256_castps256_ps128(x)); }
    static FASTCCD_INLINE __m256d widened_high(__m256 x) { return _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1)); }
    static FASTCCD_INLINE __m256 narrowed(__m256d low, __m256d high)
    {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(low)), _mm256_cvtpd_ps(high), 1);
    }
    static FASTCCD_INLINE __m256d min(__m256d a, __m256d b) { return _mm256_min_pd(a, b); }
    static FASTCCD_INLINE __m256d max(__m256d a, __m256d b) { return _mm256_max_pd(a, b); }
    static FASTCCD_INLINE __m256d difference(__m256d a, __m256d b) { return _mm256_sub_pd(a, b); }
    static FASTCCD_INLINE __m256 difference(__m256 a, __m256 b) { return _mm256_sub_ps(a, b); }
    static constexpr int transposed_columns = 4;
    template <class Batch>
    static FASTCCD_INLINE void transpose(const double* const* records, int first, Batch* columns)
    {
        const __m256d a = _mm256_loadu_pd(records[0] + first), b = _mm256_loadu_pd(records[1] + first);
        const __m256d c = _mm256_loadu_pd(records[2] + first), d = _mm256_loadu_pd(records[3] + first);
        const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b);
        const __m256d cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
        columns[0] = _mm256_permute2f128_pd(ab_even, cd_even, 0x20);
        columns[1] = _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20);
        columns[2] = _mm256_permute2f128_pd(ab_even, cd_even, 0x31);
        columns[3] = _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose(const float* const* records, int first, Batch* columns)
    {
        __m128 four[4];
        transpose_four(records, first, four);
        for (int k = 0; k < 4; ++k) columns[k] = _mm256_cvtps_pd(four[k]);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose_singles(const float* const* records, int first, Batch* columns)
    {
        __m256 four[4];
        transpose_eight(records, first, four);
        for (int k = 0; k < 4; ++k) columns[k] = four[k];
    }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
