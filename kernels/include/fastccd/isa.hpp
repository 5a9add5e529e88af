// Which instruction sets this build and this machine offer.
#pragma once

#include <optional>
#include <string_view>

#include <fastccd/options.hpp>

namespace fastccd {

/// Lower-case name: "scalar", "sse2", "avx2", "avx512", "neon", "automatic"; "unknown" for what is none of the enumerators.
[[nodiscard]] FASTCCD_API const char* name(Isa isa) noexcept;
/// The instruction set of that name; none if there is no such name.
[[nodiscard]] FASTCCD_API std::optional<Isa> isa_from_name(std::string_view name) noexcept;
/// Pairs per batch; 0 for Isa::automatic.
[[nodiscard]] FASTCCD_API int lanes(Isa isa) noexcept;
/// True if the kernels of that instruction set are part of this build; Isa::automatic is none.
[[nodiscard]] FASTCCD_API bool isa_built(Isa isa) noexcept;
/// True if isa_built and both the processor and the operating system support it.
[[nodiscard]] FASTCCD_API bool isa_available(Isa isa) noexcept;
/// The widest available instruction set.
[[nodiscard]] FASTCCD_API Isa best_isa() noexcept;

}  // namespace fastccd
