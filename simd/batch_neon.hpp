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
    static constexpr int transposed_columns = 2;
    template <class Batch>
    static FASTCCD_INLINE void transpose(const double* const* records, int first, Batch* columns)
    {
        const float64x2_t a = vld1q_f64(records[0] + first), b = vld1q_f64(records[1] + first);
        columns[0] = vzip1q_f64(a, b);
        columns[1] = vzip2q_f64(a, b);
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
