// What one call asks for, in the form the kernels use.
#pragma once

#include <error_bound.hpp>
#include <separation_bound.hpp>

namespace fastccd {

/// Times are s = t / t_max in [0, 1]. The step is cut into 2^depth leaves of equal width; the answer for a
/// pair is found in the first leaf that has no certificate of absence, is not passed along directions and, searched on below its width,
/// cannot be cleared (scalar/leaf_search.hpp): its left end, or that of a part of it, or a time just before the pair meets in it
/// (touching.hpp), or, for shapes nearly degenerate then, where their distance along directions leads from there, unless certificates lead
/// on (scalar/certified_search.cpp). That makes it independent of the way it is found.
struct SearchParameters {
    double t_max;
    ErrorBounds bounds;
    double leaf_width;  ///< w = 2^-depth, the largest with w t_max <= E_tol (at least 2^-50).
    double leaf_count;  ///< 2^depth.
    bool count_roots;
    SeparationParameters separation;  ///< With a distance above 0 times are found as in separation_steps.hpp instead.

    SearchParameters(double tolerance, double t_max_, bool count_roots_,
                     const SeparationParameters& separation_ = SeparationParameters{})
        : t_max{t_max_}, bounds{t_max_}, leaf_width{1.0}, leaf_count{1.0}, count_roots{count_roots_}, separation{separation_}
    {
        while (leaf_width * t_max > tolerance && leaf_width > 0x1p-50) {
            leaf_width *= 0.5;
            leaf_count *= 2.0;
        }
    }

    /// A time not after s t_max: the product is rounded up by at most a factor 1 + u, and
    /// (1 + u)^2 (1 - 2 u) < 1. Below 2^-1020 it is rounded up by at most 2^-1074 instead, and two doubles of that size
    /// differ by a multiple of it.
    [[nodiscard]] double time(double s) const
    {
        if (t_max == 1.0) return s;
        const double product = s * t_max;
        return product < 0x1p-1020 ? (product > 0x1p-1073 ? product - 0x1p-1073 : 0.0)
                                  : product * (1.0 - 0x1p-52);
    }
};

}  // namespace fastccd
