// Real roots by bisection with Descartes' rule of signs (Collins and Akritas 1976, in Bernstein form as by Lane and
// Riesenfeld 1981). Zero at a root is decided by the greatest common divisor, never by an interval getting small.

#include "algebraic_number.hpp"

#include <cassert>
#include <utility>

namespace fastccd::oracle {
namespace {

struct Cell {  // the interval (n, n + 1) / 2^level
    mpz_class n;
    mp_bitcnt_t level;
};

// Cells with exactly one root each, or the first dyadic root that a bisection happened to land on.
struct Isolation {
    std::vector<Cell> cells;
    std::optional<Dyadic> exact_root;
};

// p must be free of squares and not vanish at 0 or 1. The bisection ends: Descartes' rule counts 0 or 1 as soon as
// the cell is small against the distance between roots (the "two-circle theorem").
Isolation isolate(const Polynomial& p) {
    Isolation result;
    std::vector<Cell> pending{{0, 0}};
    while (!pending.empty()) {
        const Cell cell = std::move(pending.back());
        pending.pop_back();
        const int changes = sign_changes(p, cell.n, cell.level);
        if (changes == 0) continue;
        if (changes == 1) {
            result.cells.push_back(cell);
            continue;
        }
        const Dyadic middle{2 * cell.n + 1, cell.level + 1};
        if (sign_at(p, middle) == 0) return {{}, middle};
        pending.push_back({2 * cell.n, cell.level + 1});
        pending.push_back({2 * cell.n + 1, cell.level + 1});
    }
    return result;
}

// Divides p by (2^level t - n) as long as it goes, and returns how often it went.
int divide_out(Polynomial& p, const Dyadic& root) {
    Polynomial factor;
    factor.coefficient[0] = -root.numerator;
    factor.coefficient[1] = mpz_class(1) << root.level;
    int multiplicity = 0;
    while (p.degree() > 0 && sign_at(p, root) == 0) {
        p = exact_quotient(p, factor);
        ++multiplicity;
    }
    return multiplicity;
}

int multiplicity_at(const Polynomial& p, AlgebraicNumber& root) {
    int multiplicity = 0;
    for (Polynomial d = p; !d.is_zero() && root.sign_of(d) == 0; d = derivative(d)) ++multiplicity;
    return multiplicity;
}

}  // namespace

AlgebraicNumber::AlgebraicNumber(Dyadic value) : n_(std::move(value.numerator)), level_(value.level) {}

AlgebraicNumber::AlgebraicNumber(Polynomial p, mpz_class n, mp_bitcnt_t level)
    : polynomial_(std::move(p)), n_(std::move(n)), level_(level), sign_before_(sign_at(polynomial_, lower_end())) {
    assert(sign_before_ != 0 && sign_before_ == -sign_at(polynomial_, upper_end()));
}

void AlgebraicNumber::halve() {
    if (is_exact()) return;
    n_ *= 2;
    ++level_;
    const Dyadic middle{n_ + 1, level_};
    const int sign = sign_at(polynomial_, middle);
    if (sign == sign_before_) {
        n_ += 1;
    } else if (sign == 0) {
        n_ += 1;
        polynomial_ = {};
    }
}

// A common divisor of g and the polynomial has no root in the interval except possibly this number, a simple one,
// and none at the ends; so it vanishes here exactly if it changes sign.
bool AlgebraicNumber::is_root_of(const Polynomial& g) const {
    const Polynomial common = gcd(polynomial_, g);
    return common.degree() > 0 && sign_at(common, lower_end()) != sign_at(common, upper_end());
}

int AlgebraicNumber::sign_of(const Polynomial& g) {
    if (g.degree() <= 0) return sgn(g.coefficient[0]);
    // Most signs are clear after a few halvings; the zero test costs as much as several, so it comes late, once.
    constexpr int halvings_before_zero_test = 12;
    for (int halvings = 0; !is_exact(); ++halvings) {
        if (const int sign = sign_on(g, n_, level_); sign != 0) return sign;
        if (halvings == halvings_before_zero_test && is_root_of(g)) return 0;
        halve();
    }
    return sign_at(g, lower_end());
}

int AlgebraicNumber::compare_to(const Dyadic& value) const {
    if (is_exact()) return compare(lower_end(), value);
    if (compare(value, lower_end()) <= 0) return 1;
    if (compare(value, upper_end()) >= 0) return -1;
    const int sign = sign_at(polynomial_, value);
    if (sign == 0) return 0;
    return sign == sign_before_ ? 1 : -1;
}

int AlgebraicNumber::compare_to(AlgebraicNumber& other) {
    constexpr int halvings_before_equality_test = 12;
    for (int halvings = 0;; ++halvings) {
        if (other.is_exact()) return compare_to(other.lower_end());
        if (is_exact()) return -other.compare_to(lower_end());
        if (compare(upper_end(), other.lower_end()) <= 0) return -1;
        if (compare(lower_end(), other.upper_end()) >= 0) return 1;
        // Dyadic cells that overlap are nested, and the smaller one's number is inside the larger one: if it is also
        // a root of the larger one's polynomial, the two numbers are the same.
        const bool this_is_smaller = level_ >= other.level_;
        if (halvings == halvings_before_equality_test &&
            (this_is_smaller ? is_root_of(other.polynomial_) : other.is_root_of(polynomial_))) {
            return 0;
        }
        (this_is_smaller ? other : *this).halve();
    }
}

std::vector<Root> roots_in_unit_interval(const Polynomial& p) {
    assert(!p.is_zero());
    std::vector<Root> roots;
    Polynomial rest = p;  // what remains once the dyadic roots that were met are divided out
    const auto take_exact = [&](const Dyadic& place) {
        const int multiplicity = divide_out(rest, place);
        if (multiplicity > 0) roots.push_back({AlgebraicNumber(place), multiplicity});
    };
    take_exact({0, 0});
    take_exact({1, 0});
    for (;;) {
        const int changes = sign_changes(rest, 0, 0);
        if (changes == 0) return roots;
        // One sign change is one simple root: the search for multiple ones can be saved.
        const Polynomial repeated = changes == 1 ? Polynomial{} : gcd(rest, derivative(rest));
        const Polynomial square_free = repeated.degree() > 0 ? exact_quotient(rest, repeated) : rest;
        const Isolation isolation = isolate(square_free);
        if (isolation.exact_root) {
            take_exact(*isolation.exact_root);
            continue;
        }
        for (const Cell& cell : isolation.cells) {
            Root root{AlgebraicNumber(square_free, cell.n, cell.level), 1};
            if (repeated.degree() > 0) root.multiplicity = multiplicity_at(rest, root.value);
            roots.push_back(std::move(root));
        }
        return roots;
    }
}

}  // namespace fastccd::oracle
