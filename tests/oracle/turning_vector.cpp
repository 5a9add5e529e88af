#include "turning_vector.hpp"

#include <algorithm>

namespace fastccd::oracle {
namespace {

mpz_class largest_component(const IntegerVector& v) {
    return std::max({mpz_class(abs(v[0])), mpz_class(abs(v[1])), mpz_class(abs(v[2]))});
}

IntegerVector times(const mpz_class& s, const IntegerVector& v) { return {s * v[0], s * v[1], s * v[2]}; }

// n.(xj - xi)
mpz_class height_at(const IntegerVector& n, const IntegerPoints& x, std::size_t i, std::size_t j) {
    mpz_class sum;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += n[axis] * (x[j][axis] - x[i][axis]);
    return sum;
}

}  // namespace

Moment moment_at(Kind kind, const IntegerPair& pair, const Dyadic& time) {
    const IntegerPoints points = pair.at(time);
    return {time, points, shortest_vector(kind, points)};
}

TurningVector::TurningVector(const Moment& begin, const Moment& end)
    : from(times(largest_component(end.shortest.numerator), begin.shortest.numerator)),
      to(times(largest_component(begin.shortest.numerator), end.shortest.numerator)) {}

HeightCoefficients height(const TurningVector& n, const Moment& begin, const Moment& end, std::size_t i, std::size_t j) {
    return {height_at(n.from, begin.points, i, j), height_at(n.from, end.points, i, j) + height_at(n.to, begin.points, i, j),
            height_at(n.to, end.points, i, j)};
}

Moment refined(Moment m) {
    m.time.numerator *= 2;
    ++m.time.level;
    for (IntegerVector& point : m.points) {
        for (mpz_class& c : point) c *= 2;
    }
    for (mpz_class& c : m.shortest.numerator) c *= 2;
    return m;
}

}  // namespace fastccd::oracle
