#include <binary_form.hpp>

#include <algorithm>
#include <utility>

namespace fastccd::scalar {

namespace {

// As a polynomial in x = u / v, a form has the same coefficients; roots inside (0, 1) are those with x > 0. Factors
// v and u are roots at the ends of [0, 1], which are looked at separately.
using Coefficients = std::vector<mpz_class>;

void drop_leading_zeros(Coefficients& p)
{
    while (!p.empty() && p.back() == 0) p.pop_back();
}

void divide_by_content(Coefficients& p)
{
    mpz_class content = 0;
    for (const mpz_class& c : p) content = gcd(content, c);
    if (content > 1)
        for (mpz_class& c : p) mpz_divexact(c.get_mpz_t(), c.get_mpz_t(), content.get_mpz_t());
}

/// Replaces a by its pseudo-remainder by b; the pseudo-quotient if wanted. b has a non-zero leading coefficient.
void pseudo_divide(Coefficients& a, const Coefficients& b, Coefficients* quotient = nullptr)
{
    drop_leading_zeros(a);
    if (quotient != nullptr) quotient->assign(a.size() < b.size() ? 0 : a.size() - b.size() + 1, 0);
    while (a.size() >= b.size()) {
        const std::size_t shift = a.size() - b.size();
        const mpz_class leading = a.back();
        for (mpz_class& c : a) c *= b.back();
        if (quotient != nullptr) {
            for (mpz_class& c : *quotient) c *= b.back();
            (*quotient)[shift] += leading;
        }
        for (std::size_t k = 0; k < b.size(); ++k) a[k + shift] -= leading * b[k];
        drop_leading_zeros(a);
    }
}

Coefficients greatest_common_divisor(Coefficients a, Coefficients b)
{
    drop_leading_zeros(a);
    drop_leading_zeros(b);
    while (!b.empty()) {
        pseudo_divide(a, b);
        divide_by_content(a);
        std::swap(a, b);
    }
    divide_by_content(a);
    return a;
}

/// The form with the same roots inside (0, 1), each simple.
BinaryForm without_multiple_roots(const BinaryForm& f)
{
    Coefficients p = f.coefficients, slope;
    for (std::size_t k = 1; k < p.size(); ++k) slope.push_back(static_cast<unsigned long>(k) * p[k]);
    const Coefficients common = greatest_common_divisor(p, slope);
    if (common.size() <= 1) {
        drop_leading_zeros(p);
        return {p};
    }
    Coefficients quotient;
    pseudo_divide(p, common, &quotient);
    divide_by_content(quotient);
    return {quotient};
}

DyadicPart first_half(const DyadicPart& part) { return {2 * part.index, part.depth + 1}; }
DyadicPart second_half(const DyadicPart& part) { return {2 * part.index + 1, part.depth + 1}; }

/// Appends the roots of f, all simple, inside (0, 1), in order. Roots as close as coordinates of very different size allow are told apart
/// thousands of halvings down, so what waits is a list and not the caller's stack.
void isolate(const BinaryForm& f, std::vector<AlgebraicTime>& found)
{
    std::vector<DyadicPart> waiting{{0, 0}};
    while (!waiting.empty()) {
        const DyadicPart part = std::move(waiting.back());
        waiting.pop_back();
        const BinaryForm here = restricted(f, part);
        // A second half answers for the middle; a first one starts where the whole does.
        if (mpz_odd_p(part.index.get_mpz_t()) != 0 && here.at_start() == 0) found.push_back(AlgebraicTime::rational(part));
        const int variations = here.variations();
        if (variations == 0) continue;
        if (variations == 1 && here.at_start() != 0 && here.at_end() != 0) {
            found.push_back(AlgebraicTime::inside(f, part));
            continue;
        }
        waiting.push_back(second_half(part));
        waiting.push_back(first_half(part));
    }
}

}  // namespace

bool BinaryForm::is_zero() const
{
    return std::ranges::all_of(coefficients, [](const mpz_class& c) { return c == 0; });
}

int BinaryForm::variations() const
{
    int count = 0, last = 0;
    for (const mpz_class& c : coefficients) {
        if (sgn(c) == 0) continue;
        if (sgn(c) == -last) ++count;
        last = sgn(c);
    }
    return count;
}

BinaryForm operator+(const BinaryForm& a, const BinaryForm& b)
{
    BinaryForm sum = a;
    for (std::size_t k = 0; k < b.coefficients.size(); ++k) sum.coefficients[k] += b.coefficients[k];
    return sum;
}

BinaryForm operator-(const BinaryForm& a, const BinaryForm& b)
{
    BinaryForm difference = a;
    for (std::size_t k = 0; k < b.coefficients.size(); ++k) difference.coefficients[k] -= b.coefficients[k];
    return difference;
}

BinaryForm operator*(const BinaryForm& a, const BinaryForm& b)
{
    BinaryForm product;
    product.coefficients.resize(a.degree() + b.degree() + 1);
    for (std::size_t i = 0; i <= a.degree(); ++i)
        for (std::size_t k = 0; k <= b.degree(); ++k) product.coefficients[i + k] += a.coefficients[i] * b.coefficients[k];
    return product;
}

BinaryForm restricted(const BinaryForm& f, const DyadicPart& part)
{
    // With N = 2^depth and v', u' over the part: N u = index v' + (index + 1) u', N v = N (v' + u') - N u.
    const mpz_class& i = part.index;
    const mpz_class n = mpz_class{1} << part.depth;
    const BinaryForm u{{i, i + 1}}, v{{n - i, n - i - 1}};
    // Horner's rule in u, with the missing power of v supplied to each coefficient.
    BinaryForm sum{{f.coefficients.back()}}, power{{1}};
    for (std::size_t k = f.degree(); k-- > 0;) {
        power = power * v;
        sum = sum * u + BinaryForm{{f.coefficients[k]}} * power;
    }
    return sum;
}

void AlgebraicTime::halve()
{
    const DyadicPart first = first_half(where_), second = second_half(where_);
    const BinaryForm in_first = restricted(*form_, first);
    if (in_first.at_end() == 0) {
        form_.reset();
        where_ = second;
    } else {
        where_ = in_first.at_start() == in_first.at_end() ? second : first;
    }
}

int AlgebraicTime::sign(const BinaryForm& q)
{
    if (q.is_zero()) return 0;
    if (form_) {
        // A common root inside the part can only be this time, and is simple: the common divisor changes sign.
        const Coefficients common = greatest_common_divisor(form_->coefficients, q.coefficients);
        if (common.size() > 1) {
            const BinaryForm here = restricted({common}, where_);
            if (here.at_start() != here.at_end()) return 0;
        }
    }
    while (form_) {
        const BinaryForm here = restricted(q, where_);
        if (here.variations() == 0) break;
        halve();
    }
    const BinaryForm here = restricted(q, where_);
    if (!form_) return here.at_start();
    // No variation: all coefficients that are not zero have the sign that q has inside.
    return sgn(*std::ranges::find_if(here.coefficients, [](const mpz_class& c) { return c != 0; }));
}

mpz_class AlgebraicTime::floor_times_two_to(unsigned depth)
{
    while (form_ && where_.depth < depth) halve();
    if (where_.depth >= depth) return where_.index >> (where_.depth - depth);
    return where_.index << (depth - where_.depth);
}

std::vector<AlgebraicTime> roots(const BinaryForm& f)
{
    std::vector<AlgebraicTime> found;
    if (f.at_start() == 0) found.push_back(AlgebraicTime::rational({0, 0}));
    const BinaryForm simple = without_multiple_roots(f);
    isolate(simple, found);
    if (f.at_end() == 0) found.push_back(AlgebraicTime::rational({1, 0}));
    return found;
}

}  // namespace fastccd::scalar
