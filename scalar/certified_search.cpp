// The interval [0, 1] is cut into 2^depth leaves. Intervals are examined earliest first: one with a certificate is dropped, a wider
// one is halved, and a leaf without one is looked into. The first leaf that cannot be cleared is the answer. Everything before it has a
// certificate, as a whole or in parts, or is apart along a direction, so its left end is a lower bound of the first contact.
//
// A leaf in which contact cannot be proven either is searched on below E_tol: this removes near misses that are apart by more
// than rounding, whatever E_tol, and gives degenerate contacts a tighter lower bound. By certificates that lead through it or up
// to where it meets (touching.hpp); where the shape amplifies rounding, along directions, once for a pair (meeting_along_directions.hpp); by
// halving it further where these do not tell. Where leaf after leaf is cleared by its parts alone, directions keep the pair apart for longer
// (skip_along_directions), and eq. 7 is asked of wider intervals from then on.
//
// Volumes and areas of faces, edges and angles that nearly vanish are lost in rounding while the pair is still apart by sqrt(u) or
// cbrt(u) times its size, distances along a direction are not: where shapes are like that, and at a cap, the search with a separation
// goes on from there, without any separation, but where a first look in that direction has told that it would not (no_distance.hpp). It
// tells apart what computed positions tell apart.
#include <certified_search.hpp>

#include <algorithm>
#include <limits>

#include <contact_roots.hpp>
#include <pair_polynomials.hpp>
#include <scaling.hpp>
#include <separation_search.hpp>

namespace fastccd::scalar {

namespace {

template <PairKind kind>
SearchResult search(const double* coordinates, const SearchParameters& parameters, const IntervalKernel* lanes, unsigned most)
{
    const PairPolynomials<kind> pair{coordinates, parameters};
    SearchResult result{.toi = std::numeric_limits<double>::infinity(), .intervals = 1};
    if (pair.apart()) return result;

    LeafSearch<kind> leaves{pair, parameters, lanes, most};
    double first = leaves.first_contact();
    if (first <= 1.0) {
        result.proof = leaves.proof_of_contact(first);
        if (result.proof != Proof::leaf && leaves.in_doubt(first)) {
            first = apart_until(pair.coefficients(), parameters, first).toi;
            // What is proven around where it began is not before that, hence no farther from it.
            if (first <= 1.0 && result.proof == Proof::none) result.proof = leaves.proof_nearby(first);
        }
    }
    result.intervals = leaves.intervals();
    if (first > 1.0) return {.toi = result.toi, .intervals = result.intervals};
    result.toi = parameters.time(first);
    if (parameters.count_roots) {
        RootCounter<kind> counter{pair, parameters, most};
        result.roots = counter.count();
        result.root_intervals = counter.intervals();
    }
    return result;
}

}  // namespace

SearchResult certified_search(PairKind kind, const double* coordinates, const SearchParameters& parameters, const IntervalKernel* lanes,
                              unsigned most)
{
    if (!all_finite(coordinates)) return {.toi = std::numeric_limits<double>::quiet_NaN()};
    return kind == PairKind::vertex_face ? search<PairKind::vertex_face>(coordinates, parameters, lanes, most)
                                         : search<PairKind::edge_edge>(coordinates, parameters, lanes, most);
}

}  // namespace fastccd::scalar
