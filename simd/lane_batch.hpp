// The lane types xsimd::batch<double, A> and, for screening, xsimd::batch<float, A>.
//
// xsimd gives loads, arithmetic, comparisons and selection. What it lacks in version 8.1 (bits of a mask,
// storing only some lanes, min / max with MINPD's rule on NEON) is written out per architecture.
#pragma once

#include <xsimd/xsimd.hpp>

#include <lane.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class A>
struct BatchTraits;

/// Pairs collected coordinate by coordinate.
template <class Traits>
class CoordinateCollector {
public:
    FASTCCD_INLINE CoordinateCollector(const double* /*blocks*/, const double* const* pairs) : pairs_{pairs} {}
    FASTCCD_INLINE auto operator()(int c) const { return Traits::collect(pairs_, static_cast<std::size_t>(c) * block_pairs); }

private:
    const double* const* pairs_;
};

#if XSIMD_WITH_SSE2
FASTCCD_INLINE void transpose_two_records(const double* const* records, double* start, double* end, std::size_t stride)
{
    const __m128d a0 = _mm_loadu_pd(records[0]), a1 = _mm_loadu_pd(records[0] + 2), a2 = _mm_loadu_pd(records[0] + 4);
    const __m128d b0 = _mm_loadu_pd(records[1]), b1 = _mm_loadu_pd(records[1] + 2), b2 = _mm_loadu_pd(records[1] + 4);
    _mm_storeu_pd(start, _mm_unpacklo_pd(a0, b0));
    _mm_storeu_pd(start + stride, _mm_unpackhi_pd(a0, b0));
    _mm_storeu_pd(start + 2 * stride, _mm_unpacklo_pd(a1, b1));
    _mm_storeu_pd(end, _mm_unpackhi_pd(a1, b1));
    _mm_storeu_pd(end + stride, _mm_unpacklo_pd(a2, b2));
    _mm_storeu_pd(end + 2 * stride, _mm_unpackhi_pd(a2, b2));
}

template <>
struct BatchTraits<xsimd::sse2> {
    static FASTCCD_INLINE unsigned bits(__m128d m) { return static_cast<unsigned>(_mm_movemask_pd(m)); }
    using Collector = CoordinateCollector<BatchTraits>;
    static FASTCCD_INLINE __m128d collect(const double* const* from, std::size_t offset)
    {
        return _mm_set_pd(from[1][offset], from[0][offset]);
    }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, __m128d x)
    {
        _mm_storeu_pd(p, bits == 2 ? _mm_unpackhi_pd(x, x) : x);
    }
    static FASTCCD_INLINE unsigned bits(__m128 m) { return static_cast<unsigned>(_mm_movemask_ps(m)); }
    static constexpr bool screens_scenes_in_either = false;
    static FASTCCD_INLINE __m128 min(__m128 a, __m128 b) { return _mm_min_ps(a, b); }
    static FASTCCD_INLINE __m128 max(__m128 a, __m128 b) { return _mm_max_ps(a, b); }
    static FASTCCD_INLINE __m128 narrowed(__m128d low, __m128d high) { return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high)); }
    static FASTCCD_INLINE __m128d widened_low(__m128 x) { return _mm_cvtps_pd(x); }
    static FASTCCD_INLINE __m128d widened_high(__m128 x) { return _mm_cvtps_pd(_mm_movehl_ps(x, x)); }
    static FASTCCD_INLINE __m128d min(__m128d a, __m128d b) { return _mm_min_pd(a, b); }
    static FASTCCD_INLINE __m128d max(__m128d a, __m128d b) { return _mm_max_pd(a, b); }
    static FASTCCD_INLINE __m128d difference(__m128d a, __m128d b) { return _mm_sub_pd(a, b); }
    static constexpr unsigned transposed_records = 2;
    static FASTCCD_INLINE void transpose_records(const double* const* records, double* start, double* end, std::size_t stride)
    {
        transpose_two_records(records, start, end, stride);
    }
    struct FirstBox {
        __m128i start, end;
    };
    static FASTCCD_INLINE FirstBox first_box(const GridBox& box, const std::int16_t* separation)
    {
        const __m128i k = load_eight(separation);
        return {_mm_subs_epi16(k, _mm_shuffle_epi32(load_eight(box.start), 0x4e)),
                _mm_subs_epi16(k, _mm_shuffle_epi32(load_eight(box.end), 0x4e))};
    }
    static FASTCCD_INLINE bool apart(const FirstBox& first, const GridBox& second)
    {
        return _mm_movemask_epi8(_mm_and_si128(_mm_cmplt_epi16(first.start, load_eight(second.start)),
                                               _mm_cmplt_epi16(first.end, load_eight(second.end)))) != 0;
    }

private:
    static FASTCCD_INLINE __m128i load_eight(const std::int16_t* p) { return _mm_load_si128(reinterpret_cast<const __m128i*>(p)); }
};
#endif

#if XSIMD_WITH_AVX2
/// Row m moves the doubles whose bit is set in m to the front (as pairs of 32-bit lanes).
alignas(32) inline constexpr int compress_permutation[16][8] = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7}, {2, 3, 0, 1, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {4, 5, 0, 1, 2, 3, 6, 7}, {0, 1, 4, 5, 2, 3, 6, 7}, {2, 3, 4, 5, 0, 1, 6, 7}, {0, 1, 2, 3, 4, 5, 6, 7},
    {6, 7, 0, 1, 2, 3, 4, 5}, {0, 1, 6, 7, 2, 3, 4, 5}, {2, 3, 6, 7, 0, 1, 4, 5}, {0, 1, 2, 3, 6, 7, 4, 5},
    {4, 5, 6, 7, 0, 1, 2, 3}, {0, 1, 4, 5, 6, 7, 2, 3}, {2, 3, 4, 5, 6, 7, 0, 1}, {0, 1, 2, 3, 4, 5, 6, 7}};

FASTCCD_INLINE void transpose_four_records(const double* const* records, double* start, double* end, std::size_t stride)
{
    const __m256d a = _mm256_loadu_pd(records[0]), b = _mm256_loadu_pd(records[1]);
    const __m256d c = _mm256_loadu_pd(records[2]), d = _mm256_loadu_pd(records[3]);
    const __m256d ab_xz = _mm256_unpacklo_pd(a, b), ab_yx = _mm256_unpackhi_pd(a, b);
    const __m256d cd_xz = _mm256_unpacklo_pd(c, d), cd_yx = _mm256_unpackhi_pd(c, d);
    _mm256_storeu_pd(start, _mm256_permute2f128_pd(ab_xz, cd_xz, 0x20));
    _mm256_storeu_pd(start + stride, _mm256_permute2f128_pd(ab_yx, cd_yx, 0x20));
    _mm256_storeu_pd(start + 2 * stride, _mm256_permute2f128_pd(ab_xz, cd_xz, 0x31));
    _mm256_storeu_pd(end, _mm256_permute2f128_pd(ab_yx, cd_yx, 0x31));
    // y' z' of the first and third record, and of the second and fourth.
    const __m256d ac = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(records[0] + 4)), _mm_loadu_pd(records[2] + 4), 1);
    const __m256d bd = _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(records[1] + 4)), _mm_loadu_pd(records[3] + 4), 1);
    _mm256_storeu_pd(end + stride, _mm256_unpacklo_pd(ac, bd));
    _mm256_storeu_pd(end + 2 * stride, _mm256_unpackhi_pd(ac, bd));
}

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

template <>
struct BatchTraits<xsimd::avx2> : WideBoxes {
    static FASTCCD_INLINE unsigned bits(__m256d m) { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
    using Collector = CoordinateCollector<BatchTraits>;
    static FASTCCD_INLINE __m256d collect(const double* const* from, std::size_t offset)
    {
        return _mm256_set_pd(from[3][offset], from[2][offset], from[1][offset], from[0][offset]);
    }
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
    static constexpr unsigned transposed_records = 4;
    static FASTCCD_INLINE void transpose_records(const double* const* records, double* start, double* end, std::size_t stride)
    {
        transpose_four_records(records, start, end, stride);
    }
};
#endif

#if XSIMD_WITH_AVX512BW
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
#endif

#if XSIMD_WITH_NEON64
template <>
struct BatchTraits<xsimd::neon64> {
    static FASTCCD_INLINE unsigned bits(uint64x2_t m)
    {
        return static_cast<unsigned>((vgetq_lane_u64(m, 0) & 1) | (vgetq_lane_u64(m, 1) & 2));
    }
    using Collector = CoordinateCollector<BatchTraits>;
    static FASTCCD_INLINE float64x2_t collect(const double* const* from, std::size_t offset)
    {
        return vcombine_f64(vld1_f64(from[0] + offset), vld1_f64(from[1] + offset));
    }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, float64x2_t x)
    {
        vst1q_f64(p, bits == 2 ? vdupq_laneq_f64(x, 1) : x);
    }
    // vminq / vmaxq propagate NaN and order the zeros; MINPD's rule is a selection.
    static FASTCCD_INLINE float64x2_t min(float64x2_t a, float64x2_t b) { return vbslq_f64(vcltq_f64(a, b), a, b); }
    static FASTCCD_INLINE float64x2_t max(float64x2_t a, float64x2_t b) { return vbslq_f64(vcgtq_f64(a, b), a, b); }
    static FASTCCD_INLINE unsigned bits(uint32x4_t m)
    {
        const uint32x4_t lanes = {1, 2, 4, 8};
        return vaddvq_u32(vandq_u32(m, lanes));
    }
    static constexpr bool screens_scenes_in_either = false;
    static FASTCCD_INLINE float32x4_t min(float32x4_t a, float32x4_t b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
    static FASTCCD_INLINE float32x4_t max(float32x4_t a, float32x4_t b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
    static FASTCCD_INLINE float32x4_t narrowed(float64x2_t low, float64x2_t high) { return vcvt_high_f32_f64(vcvt_f32_f64(low), high); }
    static FASTCCD_INLINE float64x2_t widened_low(float32x4_t x) { return vcvt_f64_f32(vget_low_f32(x)); }
    static FASTCCD_INLINE float64x2_t widened_high(float32x4_t x) { return vcvt_high_f64_f32(x); }
    static FASTCCD_INLINE float64x2_t difference(float64x2_t a, float64x2_t b) { return vsubq_f64(a, b); }
    static constexpr unsigned transposed_records = 2;
    static FASTCCD_INLINE void transpose_records(const double* const* records, double* start, double* end, std::size_t stride)
    {
        const float64x2_t a0 = vld1q_f64(records[0]), a1 = vld1q_f64(records[0] + 2), a2 = vld1q_f64(records[0] + 4);
        const float64x2_t b0 = vld1q_f64(records[1]), b1 = vld1q_f64(records[1] + 2), b2 = vld1q_f64(records[1] + 4);
        vst1q_f64(start, vzip1q_f64(a0, b0));
        vst1q_f64(start + stride, vzip2q_f64(a0, b0));
        vst1q_f64(start + 2 * stride, vzip1q_f64(a1, b1));
        vst1q_f64(end, vzip2q_f64(a1, b1));
        vst1q_f64(end + stride, vzip1q_f64(a2, b2));
        vst1q_f64(end + 2 * stride, vzip2q_f64(a2, b2));
    }
    struct FirstBox {
        int16x8_t start, end;
    };
    static FASTCCD_INLINE FirstBox first_box(const GridBox& box, const std::int16_t* separation)
    {
        const int16x8_t k = vld1q_s16(separation);
        const int16x8_t start = vld1q_s16(box.start), end = vld1q_s16(box.end);
        return {vqsubq_s16(k, vextq_s16(start, start, 4)), vqsubq_s16(k, vextq_s16(end, end, 4))};
    }
    static FASTCCD_INLINE bool apart(const FirstBox& first, const GridBox& second)
    {
        return vmaxvq_u16(vandq_u16(vcltq_s16(first.start, vld1q_s16(second.start)),
                                    vcltq_s16(first.end, vld1q_s16(second.end)))) != 0;
    }
};
#endif

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
};

template <class A>
struct Lane<xsimd::batch<float, A>> : BatchArithmetic<float, A> {};

template <class A>
struct Lane<xsimd::batch<double, A>> : BatchArithmetic<double, A> {
    using Batch = xsimd::batch<double, A>;
    using Traits = BatchTraits<A>;

    using Screening = xsimd::batch<float, A>;
    static constexpr bool screens_scenes_in_either = Traits::screens_scenes_in_either;
    /// Both rounded, one behind the other, and back.
    static FASTCCD_INLINE Screening narrowed(Batch low, Batch high) { return Traits::narrowed(low, high); }
    template <unsigned part>
    static FASTCCD_INLINE Batch widened(Screening x)
    {
        return part == 0 ? Traits::widened_low(x) : Traits::widened_high(x);
    }

    static FASTCCD_INLINE Batch load(const double* p) { return Batch::load_unaligned(p); }
    static FASTCCD_INLINE void store(double* p, Batch x) { x.store_unaligned(p); }
    using Collector = typename Traits::Collector;
    static FASTCCD_INLINE Batch lane_number()
    {
        alignas(64) static constexpr double numbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        return Batch::load_unaligned(numbers);
    }

    static FASTCCD_INLINE Batch difference(Batch a, Batch b) { return Traits::difference(a, b); }
    static FASTCCD_INLINE Batch sqrt(Batch a) { return xsimd::sqrt(a); }
    static FASTCCD_INLINE void compress_store(double* p, unsigned bits, Batch x) { Traits::compress_store(p, bits, x); }
    /// Whether there is a Joiner{bits}: for `bits` of two batches, not more than one holds, joiner(low, high) are those lanes, in order,
    /// and any others behind them. With batches of two lanes, too often more are wanted.
    static constexpr bool can_join = requires { typename Traits::Joiner; };
    template <class T = Traits>
    using Joiner = typename T::Joiner;

    static constexpr unsigned transposed_records = Traits::transposed_records;
    static FASTCCD_INLINE void transpose_records(const double* const* records, double* start, double* end, std::size_t stride)
    {
        Traits::transpose_records(records, start, end, stride);
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
