// Batches of two doubles or four floats, in SSE2.
#pragma once

#include <batch_traits.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

/// Lane i of columns[k] becomes records[i][first + k].
FASTCCD_INLINE void transpose_four(const float* const* records, int first, __m128 (&columns)[4])
{
    const __m128 a = _mm_loadu_ps(records[0] + first), b = _mm_loadu_ps(records[1] + first);
    const __m128 c = _mm_loadu_ps(records[2] + first), d = _mm_loadu_ps(records[3] + first);
    const __m128d ab_front = _mm_castps_pd(_mm_unpacklo_ps(a, b)), ab_back = _mm_castps_pd(_mm_unpackhi_ps(a, b));
    const __m128d cd_front = _mm_castps_pd(_mm_unpacklo_ps(c, d)), cd_back = _mm_castps_pd(_mm_unpackhi_ps(c, d));
    columns[0] = _mm_castpd_ps(_mm_unpacklo_pd(ab_front, cd_front));
    columns[1] = _mm_castpd_ps(_mm_unpackhi_pd(ab_front, cd_front));
    columns[2] = _mm_castpd_ps(_mm_unpacklo_pd(ab_back, cd_back));
    columns[3] = _mm_castpd_ps(_mm_unpackhi_pd(ab_back, cd_back));
}

template <>
struct BatchTraits<xsimd::sse2> {
    static FASTCCD_INLINE unsigned bits(__m128d m) { return static_cast<unsigned>(_mm_movemask_pd(m)); }
    template <class Number>
    using Collector = CoordinateCollector<BatchTraits, Number>;
    template <class From>
    static FASTCCD_INLINE __m128d collect(From from)
    {
        return _mm_set_pd(*from(1), *from(0));
    }
    static FASTCCD_INLINE __m128d load(const float* p)
    {
        return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))));
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
    static FASTCCD_INLINE __m128 difference(__m128 a, __m128 b) { return _mm_sub_ps(a, b); }
    static constexpr int transposed_columns = 2;
    template <class Batch>
    static FASTCCD_INLINE void transpose(const double* const* records, int first, Batch* columns)
    {
        const __m128d a = _mm_loadu_pd(records[0] + first), b = _mm_loadu_pd(records[1] + first);
        columns[0] = _mm_unpacklo_pd(a, b);
        columns[1] = _mm_unpackhi_pd(a, b);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose(const float* const* records, int first, Batch* columns)
    {
        const __m128d a = load(records[0] + first), b = load(records[1] + first);
        columns[0] = _mm_unpacklo_pd(a, b);
        columns[1] = _mm_unpackhi_pd(a, b);
    }
    template <class Batch>
    static FASTCCD_INLINE void transpose_singles(const float* const* records, int first, Batch* columns)
    {
        __m128 four[4];
        transpose_four(records, first, four);
        for (int k = 0; k < 4; ++k) columns[k] = four[k];
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

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
