// Batches of eight doubles or sixteen floats, in AVX-512 F, CD, DQ and BW (simd/isa_libraries.cmake).
#pragma once

#include <batch_avx2.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Four doubles of a, then four of b.
FASTCCD_INLINE __m512d two_halves(const double* a, const double* b)
{
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(a)), _mm256_loadu_pd(b), 1);
}

FASTCCD_INLINE __m512d eight(const double* p) { return _mm512_loadu_pd(p); }
FASTCCD_INLINE __m512d eight(const float* p) { return _mm512_maskz_cvtps_pd(0xff, _mm256_loadu_ps(p)); }

template <>
struct BatchTraits<xsimd::avx512bw> : WideBoxes {
    static FASTCCD_INLINE unsigned bits(__mmask8 m) { return m; }
    /// Block by block, with one permutation for each of a block's rows: survivors of a screening come in clusters, and one after the
    /// other they take 192 loads, of which processors do two a cycle.
    template <class Number>
    class Collector {
    public:
        FASTCCD_INLINE Collector(const Number* blocks, const void* const* pairs)
        {
            const auto start = reinterpret_cast<std::uintptr_t>(blocks);
            const __m512i offsets = _mm512_sub_epi64(_mm512_loadu_si512(pairs), _mm512_set1_epi64(static_cast<long long>(start)));
            // Permutations look at the lowest three bits.
            const __m512i lanes = _mm512_srli_epi64(offsets, sizeof(Number) == sizeof(double) ? 3 : 2);
            const __m512i in_block = _mm512_and_si512(offsets, _mm512_set1_epi64(-static_cast<long long>(block_pairs * sizeof(Number))));
            alignas(64) std::uintptr_t block_offsets[8];
            _mm512_store_si512(block_offsets, in_block);
            const auto row = [&](std::uintptr_t block, int c) FASTCCD_INLINE_LAMBDA {
                return eight(reinterpret_cast<const Number*>(start + block) + block_pairs * static_cast<std::size_t>(c));
            };
            std::uintptr_t block = block_offsets[0];
#pragma GCC unroll 24
            for (int c = 0; c < 24; ++c) rows_[c] = _mm512_permutexvar_pd(lanes, row(block, c));
            // Lanes whose block is not that of the lane before.
            unsigned others = _mm512_mask_cmpneq_epi64_mask(0xfe, in_block, _mm512_alignr_epi64(in_block, in_block, 7));
#pragma GCC unroll 1
            for (; others != 0; others &= others - 1) {
                block = block_offsets[__builtin_ctz(others)];
                const __mmask8 of_it = _mm512_cmpeq_epi64_mask(in_block, _mm512_set1_epi64(static_cast<long long>(block)));
#pragma GCC unroll 24
                for (int c = 0; c < 24; ++c) rows_[c] = _mm512_mask_permutexvar_pd(rows_[c], of_it, lanes, row(block, c));
            }
        }
        FASTCCD_INLINE __m512d operator()(int c) const { return rows_[c]; }

    private:
        __m512d rows_[24];
    };
    static FASTCCD_INLINE __m512d load(const float* p) { return eight(p); }
    /// Eight from each.
    static FASTCCD_INLINE __m512 load_halves(const float* low, const float* high)
    {
        return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(low)), _mm256_loadu_ps(high), 1);
    }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, __m512d x)
    {
        // A push moves some twenty registers by the same bits: the order once, then one permutation each. Compressing is two
        // instructions each time, and storing through a mask is microcoded on some machines.
        const __m512i order = _mm512_maskz_compress_epi64(static_cast<__mmask8>(bits), _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0));
        _mm512_storeu_pd(p, _mm512_permutexvar_pd(order, x));
    }
    class Joiner {
    public:
        FASTCCD_INLINE explicit Joiner(unsigned bits)
            : order_{_mm512_maskz_cvtepu32_epi64(0xff, _mm512_castsi512_si256(_mm512_maskz_compress_epi32(
                  static_cast<__mmask16>(bits), _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0))))}
        {
        }
        FASTCCD_INLINE __m512d operator()(__m512d low, __m512d high) const { return _mm512_permutex2var_pd(low, order_, high); }

    private:
        __m512i order_;
    };
    static FASTCCD_INLINE unsigned bits(__mmask16 m) { return m; }
    static constexpr bool screens_scenes_in_either = true;  // which one is faster depends on the processor: preferences()
    static FASTCCD_INLINE __m512 min(__m512 a, __m512 b) { return _mm512_min_ps(a, b); }
    static FASTCCD_INLINE __m512 max(__m512 a, __m512 b) { return _mm512_max_ps(a, b); }
    static FASTCCD_INLINE __m512d widened_low(__m512 x) { return _mm512_maskz_cvtps_pd(0xff, _mm512_castps512_ps256(x)); }
    static FASTCCD_INLINE __m512d widened_high(__m512 x) { return _mm512_maskz_cvtps_pd(0xff, _mm512_maskz_extractf32x8_ps(0xff, x, 1)); }
    static FASTCCD_INLINE __m512 narrowed(__m512d low, __m512d high)
    {
        const __m256d lower = _mm256_castps_pd(_mm512_maskz_cvtpd_ps(0xff, low)), upper = _mm256_castps_pd(_mm512_maskz_cvtpd_ps(0xff, high));
        return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(lower), upper, 1));
    }
    static FASTCCD_INLINE __m512d min(__m512d a, __m512d b) { return _mm512_min_pd(a, b); }
    static FASTCCD_INLINE __m512d max(__m512d a, __m512d b) { return _mm512_max_pd(a, b); }
    /// 1 a - b by the units that multiply: one rounding of a - b, signs of zeros included, so the same bits. Sums, minima and
    /// comparisons are more than half of a screening, and AMD's family 26 does all of them on two of its four units, products on the
    /// other two. Intel's do either on any; where minima are done beside products, this gains nothing and may cost.
    static FASTCCD_INLINE __m512d difference(__m512d a, __m512d b) { return _mm512_fmsub_pd(a, _mm512_set1_pd(1.0), b); }
    static FASTCCD_INLINE __m512 difference(__m512 a, __m512 b) { return _mm512_fmsub_ps(a, _mm512_set1_ps(1.0f), b); }
    static constexpr int transposed_columns = 4;
    /// Records k and k + 4 are put side by side by loads, which leaves eight shuffles.
    template <class Batch>
    static FASTCCD_INLINE void transpose(const double* const* records, int first, Batch* columns)
    {
        const auto two = [&](int k) FASTCCD_INLINE_LAMBDA { return two_halves(records[k] + first, records[k + 4] + first); };
        const __m512d r0 = two(0), r1 = two(1), r2 = two(2), r3 = two(3);
        const __m512d even01 = _mm512_unpacklo_pd(r0, r1), odd01 = _mm512_unpackhi_pd(r0, r1);
        const __m512d even23 = _mm512_unpacklo_pd(r2, r3), odd23 = _mm512_unpackhi_pd(r2, r3);
        const __m512i front = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0), back = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
        columns[0] = _mm512_permutex2var_pd(even01, front, even23);
        columns[1] = _mm512_permutex2var_pd(odd01, front, odd23);
        columns[2] = _mm512_permutex2var_pd(even01, back, even23);
        columns[3] = _mm512_permutex2var_pd(odd01, back, odd23);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose(const float* const* records, int first, Batch* columns)
    {
        __m256 four[4];
        transpose_eight(records, first, four);
        for (int k = 0; k < 4; ++k) columns[k] = _mm512_maskz_cvtps_pd(0xff, four[k]);
    }
    /// Records k, k + 4, k + 8 and k + 12 side by side.
    template <class Batch>
    static FASTCCD_INLINE void transpose_singles(const float* const* records, int first, Batch* columns)
    {
        const auto four = [&](int k) FASTCCD_INLINE_LAMBDA {
            const __m512 low = _mm512_castps256_ps512(two_halves(records[k] + first, records[k + 4] + first));
            return _mm512_insertf32x8(low, two_halves(records[k + 8] + first, records[k + 12] + first), 1);
        };
        const __m512 r0 = four(0), r1 = four(1), r2 = four(2), r3 = four(3);
        const __m512d front01 = _mm512_castps_pd(_mm512_unpacklo_ps(r0, r1)), back01 = _mm512_castps_pd(_mm512_unpackhi_ps(r0, r1));
        const __m512d front23 = _mm512_castps_pd(_mm512_unpacklo_ps(r2, r3)), back23 = _mm512_castps_pd(_mm512_unpackhi_ps(r2, r3));
        columns[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(front01, front23));
        columns[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(front01, front23));
        columns[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(back01, back23));
        columns[3] = _mm512_castpd_ps(_mm512_unpackhi_pd(back01, back23));
    }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
