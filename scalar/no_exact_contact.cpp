// In a build without GMP.
#include <exact_contact.hpp>

#include <cstdlib>

namespace fastccd::scalar {

bool exact_contact_available() noexcept { return false; }

/// Options::exact is refused before.
ExactContact exact_contact(PairKind, const double*, const SearchParameters&) { std::abort(); }

}  // namespace fastccd::scalar
