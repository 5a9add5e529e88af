#pragma once

#include "pair.hpp"

namespace fastccd::oracle {

/// What the first contact is like.
enum class Class {
    none,             ///< no contact
    regular,          ///< every root of the coplanarity cubic with contact is simple: the primitives cross
    tangential,       ///< some root with contact is multiple: the primitives touch and part, or nearly so
    always_coplanar,  ///< the cubic is identically zero
};

struct Verdict {
    bool contact = false;

    /// The exact first time of contact lies in [t_lo, t_hi]: the same double if the time is one, else neighbouring
    /// doubles with the time strictly between. Both +inf without contact.
    double t_lo, t_hi;

    /// Roots of the coplanarity cubic in [0, t_max] at which there is contact, counted with multiplicity: its parity
    /// is that of the paper's odd and even collisions (section 6). 0 without contact, -1 if there is contact and the
    /// cubic is identically zero.
    int roots = 0;

    Class contact_class = Class::none;
    bool at_start = false;    ///< in contact at t = 0
    bool at_end = false;      ///< in contact at t = t_max, whether or not before
    bool degenerate = false;  ///< at first contact the face has no area, or the edges are parallel or one is a point
};

/// Decides exactly whether, and when first, the closed primitives touch at a time in the closed interval [0, t_max].
/// Any finite coordinates, subnormal and huge numbers mixed; finite t_max >= 0. Else throws std::invalid_argument.
///
/// Truth by brute force: no floating-point number takes part in a decision, and no filter is in the way.
Verdict exact_ccd(Kind kind, const Pair& pair, double t_max = 1.0);

}  // namespace fastccd::oracle
