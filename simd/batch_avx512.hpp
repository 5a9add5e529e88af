// Batches of eight doubles or sixteen floats, in AVX-512 F, CD, DQ and BW (simd/isa_libraries.cmake).
#pragma once

#include <batch_avx2.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// x y z x' of a and of b.
FASTCCD_INLINE __m512d two_halves(const double* a, const double* b)
{
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(a)), _mm256_loadu_pd(b), 1);
}

/// y' z' of a, b, c, d.
FASTCCD_INLINE __m512d four_quarters(const double* a, const double* b, const double* c, const double* d)
{
    __m512d quarters = _mm512_maskz_broadcast_f64x2(0x03, _mm_loadu_pd(a + 4));
    quarters = _mm512_mask_broadcast_f64x2(quarters, 0x0c, _mm_loadu_pd(b + 4));
    quarters = _mm512_mask_broadcast_f64x2(quarters, 0x30, _mm_loadu_pd(c + 4));
    return _mm512_mask_broadcast_f64x2(quarters, 0xc0, _mm_loadu_pd(d + 4));
}

/// Parts of records are put side by side by loads, which do not need the ports that shuffle: ten shuffles instead of the 22 of
/// whole registers, and 16 loads instead of 24 that broadcast two numbers each.
FASTCCD_INLINE void transpose_eight_records(const double* const* records, double* start, double* end, std::size_t stride)
{
    // Copies: the compiler must take it that the stores below might change the originals.
    const double *const r0 = records[0], *const r1 = records[1], *const r2 = records[2], *const r3 = records[3];
    const double *const r4 = records[4], *const r5 = records[5], *const r6 = records[6], *const r7 = records[7];
    const __m512d r02 = two_halves(r0, r2), r13 = two_halves(r1, r3), r46 = two_halves(r4, r6), r57 = two_halves(r5, r7);
    const __m512d xz_first = _mm512_unpacklo_pd(r02, r13), xz_last = _mm512_unpacklo_pd(r46, r57);
    const __m512d yx_first = _mm512_unpackhi_pd(r02, r13), yx_last = _mm512_unpackhi_pd(r46, r57);
    const __m512d even = four_quarters(r0, r2, r4, r6), odd = four_quarters(r1, r3, r5, r7);
    _mm512_storeu_pd(start, _mm512_shuffle_f64x2(xz_first, xz_last, 0x88));
    _mm512_storeu_pd(start + stride, _mm512_shuffle_f64x2(yx_first, yx_last, 0x88));
    _mm512_storeu_pd(start + 2 * stride, _mm512_shuffle_f64x2(xz_first, xz_last, 0xdd));
    _mm512_storeu_pd(end, _mm512_shuffle_f64x2(yx_first, yx_last, 0xdd));
    _mm512_storeu_pd(end + stride, _mm512_unpacklo_pd(even, odd));
    _mm512_storeu_pd(end + 2 * stride, _mm512_unpackhi_pd(even, odd));
}

template <>
struct BatchTraits<xsimd::avx512bw> : WideBoxes {
    static FASTCCD_INLINE unsigned bits(__mmask8 m) { return m; }
    /// Block by block, with one permutation for each of a block's rows: survivors of a screening come in clusters, and one after the
    /// other they take 192 loads, of which processors do two a cycle.
    class Collector {
    public:
        FASTCCD_INLINE Collector(const double* blocks, const double* const* pairs)
        {
            const auto start = reinterpret_cast<std::uintptr_t>(blocks);
            const __m512i offsets = _mm512_sub_epi64(_mm512_loadu_si512(pairs), _mm512_set1_epi64(static_cast<long long>(start)));
            const __m512i lanes = _mm512_srli_epi64(offsets, 3);  // permutations look at the lowest three bits
            const __m512i in_block = _mm512_and_si512(offsets, _mm512_set1_epi64(-64));
            alignas(64) std::uintptr_t block_offsets[8];
            _mm512_store_si512(block_offsets, in_block);
            const auto row = [&](std::uintptr_t block, int c) FASTCCD_INLINE_LAMBDA {
                return _mm512_loadu_pd(reinterpret_cast<const double*>(start + block) + block_pairs * static_cast<std::size_t>(c));
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
    static constexpr unsigned transposed_records = 8;
    static FASTCCD_INLINE void transpose_records(const double* const* records, double* start, double* end, std::size_t stride)
    {
        transpose_eight_records(records, start, end, stride);
    }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
