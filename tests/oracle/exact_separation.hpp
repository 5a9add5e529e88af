#pragma once

#include "pair.hpp"

namespace fastccd::oracle {

enum class Farther {
    certainly,  ///< Farther than d all the time.
    closer,     ///< At some time the distance is at most d.
    not_shown,  ///< The limits do not allow to tell.
};

/// Whether the distance of the closed primitives exceeds d >= 0 at all times of [t_begin, t_end], by halving the interval up
/// to `depth` times and looking at no more than `max_intervals`, in rational arithmetic throughout. Both verdicts are
/// exact: `certainly` is shown by turning planes that keep d of distance, `closer` by the exact distance at one time.
Farther farther_throughout(Kind kind, const Pair& pair, double d, double t_begin, double t_end, int depth = 200,
                           int max_intervals = 5000);

}  // namespace fastccd::oracle
