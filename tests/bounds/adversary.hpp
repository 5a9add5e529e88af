// A search for the inputs on which a computation errs most.
//
// Random inputs exercise a rounding error bound badly: errors cancel. Here single coordinates are changed again and
// again, bits, signs and places within a binade, and a change is kept if the ratio of the error to its bound does not
// fall. A bound that is too small does not survive long; one that stays far above everything found is loose, which the
// printed ratios show.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>

namespace fastccd::testing {

/// 24 coordinates, and times for those computations that have some.
struct Input {
    std::array<double, 24> x;
    double t_max;
    double a, b;  ///< 0 <= a <= b <= 1
};

class Adversary {
public:
    explicit Adversary(std::uint64_t seed) : bits_{seed} {}

    double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53; }
    int integer(int low, int high) { return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1)); }
    bool chance(double p) { return uniform(0, 1) < p; }
    double sign() { return chance(0.5) ? 1.0 : -1.0; }

    /// In [-1, 1]: anywhere, or within a few ulps of the end of a binade, where relative rounding errors are
    /// largest (just above) and smallest (just below).
    double coordinate()
    {
        if (chance(0.4)) return uniform(-1, 1);
        const double top = std::ldexp(1.0, -integer(0, 2));
        return sign() * (top + (chance(0.5) ? -1 : 1) * integer(0, 40) * top * 0x1p-53);
    }

    double time()
    {
        switch (integer(0, 5)) {
            case 0: return 0.0;
            case 1: return 1.0;
            case 2: return std::ldexp(uniform(0.5, 1), -integer(0, 60));
            case 3: return integer(1, 15) / 16.0;
            default: return uniform(0, 1);
        }
    }

    /// `largest_shift`: axes are scaled by 2^-shift .. 2^shift, each by its own.
    Input input(double t_max, int smallest_shift, int largest_shift)
    {
        Input in{};
        const bool offset = chance(0.2);
        double scale[3], origin[3];
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = std::ldexp(1.0, integer(smallest_shift, largest_shift));
            origin[axis] = offset ? uniform(-64, 64) : 0.0;
        }
        for (std::size_t c = 0; c < 24; ++c) in.x[c] = (coordinate() + origin[c % 3]) * scale[c % 3];
        in.t_max = t_max;
        set_times(in);
        return in;
    }

    /// Changes one to three coordinates, or the times.
    Input changed(Input in)
    {
        for (int n = integer(1, 3); n > 0; --n) {
            double& x = in.x[static_cast<std::size_t>(integer(0, 23))];
            switch (integer(0, 7)) {
                case 0: x = -x; break;
                case 1: x = in.x[static_cast<std::size_t>(&x - in.x.data()) % 3 + 3u * static_cast<unsigned>(integer(0, 7))]; break;
                case 2: x = std::nextafter(x, sign() * 1e300); break;
                case 3: {  // to an end of its binade
                    const double end = std::ldexp(x < 0 ? -1.0 : 1.0, x == 0 ? 0 : std::ilogb(x) + integer(0, 1));
                    x = x == 0 ? 0 : end * (1 + integer(-3, 3) * 0x1p-52);
                    break;
                }
                default: x *= 1 + uniform(-1, 1) * std::ldexp(1.0, -integer(2, 53));
            }
        }
        if (chance(0.15)) set_times(in);
        return in;
    }

    /// The largest value of ratio(input) found in so many restarts of so many steps. Negative ratios say by how
    /// much an input is outside what the ratio is about.
    template <class Start, class Change, class Ratio>
    auto worst(int restarts, int steps, Start start, Change change, Ratio ratio)
    {
        auto best = start();
        double best_ratio = ratio(best);
        for (int restart = 0; restart < restarts; ++restart) {
            auto current = restart == 0 ? best : start();
            double current_ratio = ratio(current);
            for (int step = 0; step < steps; ++step) {
                auto candidate = change(current);
                const double candidate_ratio = ratio(candidate);
                if (!(candidate_ratio >= current_ratio)) continue;
                current = candidate;
                current_ratio = candidate_ratio;
            }
            if (current_ratio > best_ratio) best = current, best_ratio = current_ratio;
        }
        return std::pair{best, best_ratio};
    }

private:
    void set_times(Input& in)
    {
        in.a = time();
        in.b = time();
        if (chance(0.3)) in.b = std::min(1.0, in.a + std::ldexp(1.0, -integer(1, 50)));
        if (in.a > in.b) std::swap(in.a, in.b);
    }

    std::mt19937_64 bits_;
};

/// Lossless, for failures.
inline std::string text(const Input& in)
{
    std::string result;
    char number[40];
    for (const double x : in.x) {
        std::snprintf(number, sizeof number, "%a ", x);
        result += number;
    }
    std::snprintf(number, sizeof number, "t_max %a ", in.t_max);
    result += number;
    std::snprintf(number, sizeof number, "on [%a, ", in.a);
    result += number;
    std::snprintf(number, sizeof number, "%a]", in.b);
    return result + number;
}

}  // namespace fastccd::testing
