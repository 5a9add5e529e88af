// Batches of two doubles or four floats, in the NEON of arm64.
#pragma once

#include <batch_traits.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <>
struct BatchTraits<xsimd::neon64> {
    static FASTCCD_INLINE unsigned bits(uint64x2_t m)
    {
        return static_cast<unsigned>((vgetq_lane_u64(m, 0) & 1) | (vgetq_lane_u64(m, 1) & 2));
    }
    template <class Number>
    using Collector = CoordinateCollector<BatchTraits, Number>;
    template <class From>
    static FASTCCD_INLINE float64x2_t collect(From from)
    {
        return float64x2_t{*from(0), *from(1)};
    }
    static FASTCCD_INLINE float64x2_t load(const float* p) { return vcvt_f64_f32(vld1_f32(p)); }
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
    static FASTCCD_INLINE float32x4_t difference(float32x4_t a, float32x4_t b) { return vsubq_f32(a, b); }
    static constexpr int transposed_columns = 2;
    template <class Batch>
    static FASTCCD_INLINE void transpose(const double* const* records, int first, Batch* columns)
    {
        const float64x2_t a = vld1q_f64(records[0] + first), b = vld1q_f64(records[1] + first);
        columns[0] = vzip1q_f64(a, b);
        columns[1] = vzip2q_f64(a, b);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose(const float* const* records, int first, Batch* columns)
    {
        const float64x2_t a = load(records[0] + first), b = load(records[1] + first);
        columns[0] = vzip1q_f64(a, b);
        columns[1] = vzip2q_f64(a, b);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose_singles(const float* const* records, int first, Batch* columns)
    {
        const float32x4_t a = vld1q_f32(records[0] + first), b = vld1q_f32(records[1] + first);
        const float32x4_t c = vld1q_f32(records[2] + first), d = vld1q_f32(records[3] + first);
        const float64x2_t ab_even = vreinterpretq_f64_f32(vtrn1q_f32(a, b)), ab_odd = vreinterpretq_f64_f32(vtrn2q_f32(a, b));
        const float64x2_t cd_even = vreinterpretq_f64_f32(vtrn1q_f32(c, d)), cd_odd = vreinterpretq_f64_f32(vtrn2q_f32(c, d));
        columns[0] = vreinterpretq_f32_f64(vzip1q_f64(ab_even, cd_even));
        columns[1] = vreinterpretq_f32_f64(vzip1q_f64(ab_odd, cd_odd));
        columns[2] = vreinterpretq_f32_f64(vzip2q_f64(ab_even, cd_even));
        columns[3] = vreinterpretq_f32_f64(vzip2q_f64(ab_odd, cd_odd));
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

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
