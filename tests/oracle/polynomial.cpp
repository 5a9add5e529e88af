#include "polynomial.hpp"

#include <cassert>

namespace fastccd::oracle {
namespace {

mpz_class content(const Polynomial& p) {
    mpz_class result;
    for (const mpz_class& c : p.coefficient) result = gcd(result, c);
    return result;
}

struct Division {
    Polynomial quotient, remainder;  // of lead(b)^k a, for some k
};

// Pseudo-division: multiplying a by the leading coefficient of b before every step keeps the integers.
Division divide(const Polynomial& a, const Polynomial& b) {
    const int b_degree = b.degree();
    assert(b_degree >= 0);
    const mpz_class& lead = b.coefficient[static_cast<std::size_t>(b_degree)];
    Division d{{}, a};
    for (int degree = a.degree(); degree >= b_degree; --degree) {
        const mpz_class factor = d.remainder.coefficient[static_cast<std::size_t>(degree)];
        for (mpz_class& c : d.remainder.coefficient) c *= lead;
        for (mpz_class& c : d.quotient.coefficient) c *= lead;
        const auto shift = static_cast<std::size_t>(degree - b_degree);
        d.quotient.coefficient[shift] += factor;
        for (std::size_t i = 0; i + shift < 4; ++i) d.remainder.coefficient[i + shift] -= factor * b.coefficient[i];
    }
    return d;
}

}  // namespace

int Polynomial::degree() const {
    for (int i = 3; i >= 0; --i) {
        if (sgn(coefficient[static_cast<std::size_t>(i)]) != 0) return i;
    }
    return -1;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
    Polynomial sum;
    for (std::size_t i = 0; i < 4; ++i) sum.coefficient[i] = a.coefficient[i] + b.coefficient[i];
    return sum;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
    Polynomial difference;
    for (std::size_t i = 0; i < 4; ++i) difference.coefficient[i] = a.coefficient[i] - b.coefficient[i];
    return difference;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    assert(a.degree() + b.degree() <= 3);
    Polynomial product;
    for (std::size_t i = 0; i < 4; ++i) {
        if (sgn(a.coefficient[i]) == 0) continue;
        for (std::size_t j = 0; i + j < 4; ++j) {
            mpz_addmul(product.coefficient[i + j].get_mpz_t(), a.coefficient[i].get_mpz_t(),
                       b.coefficient[j].get_mpz_t());
        }
    }
    return product;
}

Polynomial derivative(const Polynomial& p) {
    Polynomial result;
    for (unsigned i = 1; i < 4; ++i) result.coefficient[i - 1] = i * p.coefficient[i];
    return result;
}

Polynomial primitive_part(const Polynomial& p) {
    const int degree = p.degree();
    if (degree < 0) return p;
    mpz_class divisor = content(p);
    if (sgn(p.coefficient[static_cast<std::size_t>(degree)]) < 0) divisor = -divisor;
    Polynomial result;
    for (std::size_t i = 0; i < 4; ++i) {
        mpz_divexact(result.coefficient[i].get_mpz_t(), p.coefficient[i].get_mpz_t(), divisor.get_mpz_t());
    }
    return result;
}

Polynomial gcd(const Polynomial& a, const Polynomial& b) {
    Polynomial larger = primitive_part(a), smaller = primitive_part(b);
    while (!smaller.is_zero()) {  // Euclid; a remainder of a smaller degree simply swaps the two
        Polynomial remainder = primitive_part(divide(larger, smaller).remainder);
        larger = std::move(smaller);
        smaller = std::move(remainder);
    }
    return larger;
}

Polynomial exact_quotient(const Polynomial& a, const Polynomial& b) {
    const Division d = divide(a, b);
    assert(d.remainder.is_zero());
    return primitive_part(d.quotient);
}

int sign_at(const Polynomial& p, const Dyadic& place) {
    // Horner's rule on 2^(level degree) p(numerator / 2^level).
    const int degree = p.degree();
    if (degree < 0) return 0;
    mpz_class value = p.coefficient[static_cast<std::size_t>(degree)];
    mpz_class term;
    for (int i = degree - 1; i >= 0; --i) {
        value *= place.numerator;
        term = p.coefficient[static_cast<std::size_t>(i)] << (place.level * static_cast<mp_bitcnt_t>(degree - i));
        value += term;
    }
    return sgn(value);
}

std::array<mpz_class, 4> bernstein(const Polynomial& p, const mpz_class& n, mp_bitcnt_t level) {
    // c(u) = 2^(level degree) p((n + u) / 2^level): first scale the variable, then shift it by n.
    std::array<mpz_class, 4> c = p.coefficient;
    const int degree = p.degree();
    for (int i = 0; i < degree; ++i) {
        c[static_cast<std::size_t>(i)] <<= level * static_cast<mp_bitcnt_t>(degree - i);
    }
    if (sgn(n) != 0) {
        for (int i = 0; i < degree; ++i) {
            for (int j = degree - 1; j >= i; --j) {
                mpz_addmul(c[static_cast<std::size_t>(j)].get_mpz_t(), c[static_cast<std::size_t>(j) + 1].get_mpz_t(),
                           n.get_mpz_t());
            }
        }
    }
    // Power basis to cubic Bernstein basis on [0, 1], times 3:
    // 3 b0 = 3 c0, 3 b1 = 3 c0 + c1, 3 b2 = 3 c0 + 2 c1 + c2, 3 b3 = 3 (c0 + c1 + c2 + c3).
    std::array<mpz_class, 4> b;
    b[0] = 3 * c[0];
    b[1] = b[0] + c[1];
    b[2] = b[1] + c[1] + c[2];
    b[3] = 3 * (c[0] + c[1] + c[2] + c[3]);
    return b;
}

int sign_on(const Polynomial& p, const mpz_class& n, mp_bitcnt_t level) {
    const std::array<mpz_class, 4> b = bernstein(p, n, level);
    const int sign = sgn(b[0]);
    for (std::size_t i = 1; i < 4; ++i) {
        if (sgn(b[i]) != sign) return 0;
    }
    return sign;
}

int sign_changes(const Polynomial& p, const mpz_class& n, mp_bitcnt_t level) {
    int changes = 0, last = 0;
    for (const mpz_class& b : bernstein(p, n, level)) {
        const int sign = sgn(b);
        if (sign == 0) continue;
        if (last != 0 && sign != last) ++changes;
        last = sign;
    }
    return changes;
}

}  // namespace fastccd::oracle
