// Portable lane types of any width and either precision, one operation after the other: the logic of the widest batches, on machines
// without them, and single precision where no batch is built.
#pragma once

#include <cmath>
#include <type_traits>

#include <lane.hpp>

namespace fastccd::FASTCCD_KERNEL_NAMESPACE {

template <class T, unsigned n>
struct Array {
    T value[n];
};

template <class R, class Operation>
R each(Operation operation)
{
    R result;
    unsigned i = 0;
    for (auto& value : result.value) value = operation(i++);
    return result;
}

template <class T, unsigned n>
Array<T, n> operator+(Array<T, n> a, Array<T, n> b)
{
    return each<Array<T, n>>([&](unsigned i) { return a.value[i] + b.value[i]; });
}
template <class T, unsigned n>
Array<T, n> operator-(Array<T, n> a, Array<T, n> b)
{
    return each<Array<T, n>>([&](unsigned i) { return a.value[i] - b.value[i]; });
}
template <class T, unsigned n>
Array<T, n> operator*(Array<T, n> a, Array<T, n> b)
{
    return each<Array<T, n>>([&](unsigned i) { return a.value[i] * b.value[i]; });
}
template <class T, unsigned n>
Array<T, n> operator/(Array<T, n> a, Array<T, n> b)
{
    return each<Array<T, n>>([&](unsigned i) { return a.value[i] / b.value[i]; });
}
template <unsigned n>
Array<bool, n> operator&(Array<bool, n> a, Array<bool, n> b)
{
    return each<Array<bool, n>>([&](unsigned i) { return a.value[i] && b.value[i]; });
}
template <unsigned n>
Array<bool, n> operator|(Array<bool, n> a, Array<bool, n> b)
{
    return each<Array<bool, n>>([&](unsigned i) { return a.value[i] || b.value[i]; });
}
template <unsigned n>
Array<bool, n> operator!(Array<bool, n> a)
{
    return each<Array<bool, n>>([&](unsigned i) { return !a.value[i]; });
}

template <class T, unsigned n>
struct Lane<Array<T, n>> {
    using One = Lane<double>;
    using Values = Array<T, n>;
    using Mask = Array<bool, n>;
    static constexpr unsigned width = n;
    static constexpr bool is_single = std::is_same_v<T, float>;
    using Screening = Array<float, 2 * n>;
    static constexpr bool screens_scenes_in_either = true;
    static Screening narrowed(Values low, Values high)
    {
        return each<Screening>([&](unsigned i) { return static_cast<float>(i < n ? low.value[i] : high.value[i - n]); });
    }
    template <unsigned part>
    static Values widened(Screening x)
    {
        return each<Values>([&](unsigned i) { return T{x.value[part * n + i]}; });
    }

    static Values broadcast(double x)
    {
        return each<Values>([&](unsigned) { return static_cast<T>(x); });
    }
    template <class Number>
    static Values load(const Number* p)
    {
        return each<Values>([&](unsigned i) { return T{p[i]}; });
    }
    static Values load_halves(const T* low, const T* high)
    {
        return each<Values>([&](unsigned i) { return i < n / 2 ? low[i] : high[i - n / 2]; });
    }
    static void store(T* p, Values x)
    {
        for (unsigned i = 0; i < n; ++i) p[i] = x.value[i];
    }
    template <class Number>
    struct Collector {
        Collector(const Number* /*blocks*/, const void* const* pairs_) : pairs{pairs_} {}
        Values operator()(int c) const
        {
            return each<Values>([&](unsigned i) { return T{static_cast<const Number*>(pairs[i])[std::size_t(c) * block_pairs]}; });
        }
        const void* const* pairs;
    };
    static Values lane_number()
    {
        return each<Values>([](unsigned i) { return T(i); });
    }
    static Values min(Values a, Values b)
    {
        return each<Values>([&](unsigned i) { return a.value[i] < b.value[i] ? a.value[i] : b.value[i]; });
    }
    static Values max(Values a, Values b)
    {
        return each<Values>([&](unsigned i) { return a.value[i] > b.value[i] ? a.value[i] : b.value[i]; });
    }
    static Values abs(Values a)
    {
        return each<Values>([&](unsigned i) { return std::fabs(a.value[i]); });
    }
    static Values negated(Values a)
    {
        return each<Values>([&](unsigned i) { return -a.value[i]; });
    }
    static Values power_of_two(Values a)
    {
        return each<Values>([&](unsigned i) { return static_cast<T>(One::power_of_two(a.value[i])); });
    }
    static Values times_sign(Values a, Values b)
    {
        return each<Values>([&](unsigned i) { return std::signbit(b.value[i]) ? -a.value[i] : a.value[i]; });
    }
    static Values difference(Values a, Values b) { return a - b; }
    static Values sqrt(Values a)
    {
        return each<Values>([&](unsigned i) { return std::sqrt(a.value[i]); });
    }
    static Values select(Mask m, Values yes, Values no)
    {
        return each<Values>([&](unsigned i) { return m.value[i] ? yes.value[i] : no.value[i]; });
    }
    static Mask less(Values a, Values b)
    {
        return each<Mask>([&](unsigned i) { return a.value[i] < b.value[i]; });
    }
    static Mask less_equal(Values a, Values b)
    {
        return each<Mask>([&](unsigned i) { return a.value[i] <= b.value[i]; });
    }
    static unsigned bits(Mask m)
    {
        unsigned result = 0;
        for (unsigned i = 0; i < n; ++i) result |= unsigned{m.value[i]} << i;
        return result;
    }
    static void compress_store(T* p, unsigned bits, Values x)
    {
        for (unsigned i = 0; i < n; ++i)
            if ((bits >> i & 1u) != 0) *p++ = x.value[i];
    }
    static constexpr bool can_join = true;
    template <class = void>
    struct Joiner {
        explicit Joiner(unsigned bits_) : bits{bits_} {}
        Values operator()(Values low, Values high) const
        {
            Values joined = low;
            unsigned count = 0;
            for (unsigned i = 0; i < 2 * n; ++i)
                if ((bits >> i & 1u) != 0) joined.value[count++] = i < n ? low.value[i] : high.value[i - n];
            return joined;
        }
        unsigned bits;
    };
    static constexpr int transposed_columns = 1;
    template <class Number>
    static void transpose(const Number* const* records, int first, Values* columns)
    {
        columns[0] = each<Values>([&](unsigned i) { return T{records[i][first]}; });
    }
    using FirstBox = One::FirstBox;
    static FirstBox first_box(const GridBox& box, const std::int16_t* separation) { return One::first_box(box, separation); }
    static bool apart(const FirstBox& first, const GridBox& second) { return One::apart(first, second); }
};

}  // namespace fastccd::FASTCCD_KERNEL_NAMESPACE
