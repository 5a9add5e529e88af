// Contact implies that the four points are coplanar. So:
//
// - If the cubic is not identically zero, contact is possible at its roots only, at most three times. Each is isolated
//   exactly and the planar contact decided there by signs of polynomials at the root.
// - If it is identically zero, contact at time u is a Boolean combination of the signs at u of finitely many
//   polynomials (ExactMotion::planar_events). Between neighbouring roots of these, no sign changes, so neither does
//   contact. The times of contact form a closed set; hence the first one is 0 or one of these roots.

#include "exact_ccd.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "exact_motion.hpp"

namespace fastccd::oracle {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Neighbouring doubles around u 2^time_exponent, by bisection over the doubles of [0, t_max] in their order. For
// doubles >= 0 it is the order of their bit patterns.
std::pair<double, double> enclose(const AlgebraicNumber& u, int time_exponent, double t_max) {
    const auto side = [&](std::uint64_t bits) {  // sign of u minus this double
        return u.compare_to(to_dyadic(std::bit_cast<double>(bits), time_exponent));
    };
    std::uint64_t lo = std::bit_cast<std::uint64_t>(0.0), hi = std::bit_cast<std::uint64_t>(t_max + 0.0);
    if (side(lo) == 0) return {0.0, 0.0};
    if (side(hi) == 0) return {t_max, t_max};
    while (hi - lo > 1) {
        const std::uint64_t middle = lo + (hi - lo) / 2;
        const int s = side(middle);
        if (s == 0) return {std::bit_cast<double>(middle), std::bit_cast<double>(middle)};
        (s > 0 ? lo : hi) = middle;
    }
    return {std::bit_cast<double>(lo), std::bit_cast<double>(hi)};
}

struct Contact {
    AlgebraicNumber time;
    bool degenerate;
};

struct Search {
    Kind kind;
    ExactMotion motion;
    std::optional<Contact> first;

    // Notes contact at `time` if it is the earliest so far.
    bool test(AlgebraicNumber& time) {
        const StaticContact contact = contact_at(kind, motion, time);
        if (contact.touching && (!first || time.compare_to(first->time) < 0)) {
            first = Contact{time, contact.degenerate};
        }
        return contact.touching;
    }
};

void search_roots_of_cubic(Search& search, const Polynomial& cubic, Verdict& verdict) {
    bool all_simple = true;
    for (Root& root : roots_in_unit_interval(cubic)) {
        const int against_end = root.value.compare_to(search.motion.end());
        if (against_end > 0 || !search.test(root.value)) continue;
        verdict.roots += root.multiplicity;
        all_simple = all_simple && root.multiplicity == 1;
        verdict.at_start = verdict.at_start || root.value.compare_to(Dyadic{}) == 0;
        verdict.at_end = verdict.at_end || against_end == 0;
    }
    if (search.first) verdict.contact_class = all_simple ? Class::regular : Class::tangential;
}

void search_planar_events(Search& search, Verdict& verdict) {
    AlgebraicNumber start(Dyadic{}), end(search.motion.end());
    verdict.at_start = search.test(start);
    verdict.at_end = search.test(end);
    if (!verdict.at_start) {
        for (const Polynomial& event : search.motion.planar_events()) {
            for (Root& root : roots_in_unit_interval(event)) {
                if (root.value.compare_to(search.motion.end()) > 0) continue;
                if (search.first && root.value.compare_to(search.first->time) >= 0) continue;
                search.test(root.value);
            }
        }
    }
    if (search.first) {
        verdict.contact_class = Class::always_coplanar;
        verdict.roots = -1;
    }
}

}  // namespace

Verdict exact_ccd(Kind kind, const Pair& pair, double t_max) {
    if (!is_finite(pair)) throw std::invalid_argument("exact_ccd: a coordinate is not finite");
    if (!std::isfinite(t_max) || t_max < 0.0) throw std::invalid_argument("exact_ccd: t_max is not finite and >= 0");

    Search search{kind, ExactMotion(pair, t_max), std::nullopt};
    Verdict verdict{.t_lo = infinity, .t_hi = infinity};
    const Polynomial cubic = search.motion.volume();
    if (cubic.is_zero()) {
        search_planar_events(search, verdict);
    } else {
        search_roots_of_cubic(search, cubic, verdict);
    }
    if (search.first) {
        verdict.contact = true;
        verdict.degenerate = search.first->degenerate;
        std::tie(verdict.t_lo, verdict.t_hi) = enclose(search.first->time, search.motion.time_exponent(), t_max);
    }
    return verdict;
}

}  // namespace fastccd::oracle
