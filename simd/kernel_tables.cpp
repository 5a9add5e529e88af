// The kernels in this build, and which of them this machine can run.
#include <kernel_table.hpp>

#include <fastccd/isa.hpp>

namespace fastccd {

namespace scalar_lanes {
extern const KernelTable table;
}
#if defined(FASTCCD_HAVE_X86)
namespace sse2_lanes {
extern const KernelTable table;
}
#endif
#if defined(FASTCCD_HAVE_AVX2)
namespace avx2_lanes {
extern const KernelTable table;
}
#endif
#if defined(FASTCCD_HAVE_AVX512)
namespace avx512_lanes {
extern const KernelTable table;
}
#endif
#if defined(FASTCCD_HAVE_NEON)
namespace neon_lanes {
extern const KernelTable table;
}
#endif

const KernelTable* kernel_table(Isa isa) noexcept
{
    switch (isa) {
        case Isa::scalar: return &scalar_lanes::table;
#if defined(FASTCCD_HAVE_X86)
        case Isa::sse2: return &sse2_lanes::table;
#endif
#if defined(FASTCCD_HAVE_AVX2)
        case Isa::avx2: return &avx2_lanes::table;
#endif
#if defined(FASTCCD_HAVE_AVX512)
        case Isa::avx512: return &avx512_lanes::table;
#endif
#if defined(FASTCCD_HAVE_NEON)
        case Isa::neon: return &neon_lanes::table;
#endif
        default: return nullptr;
    }
}

const char* name(Isa isa) noexcept
{
    switch (isa) {
        case Isa::automatic: return "automatic";
        case Isa::scalar: return "scalar";
        case Isa::sse2: return "sse2";
        case Isa::avx2: return "avx2";
        case Isa::avx512: return "avx512";
        case Isa::neon: return "neon";
    }
    return "unknown";
}

namespace {

constexpr Isa widest_first[] = {Isa::avx512, Isa::avx2, Isa::neon, Isa::sse2, Isa::scalar};

}  // namespace

std::optional<Isa> isa_from_name(std::string_view text) noexcept
{
    if (text == name(Isa::automatic)) return Isa::automatic;
    for (const Isa isa : widest_first)
        if (text == name(isa)) return isa;
    return std::nullopt;
}

int lanes(Isa isa) noexcept
{
    switch (isa) {
        case Isa::automatic: return 0;
        case Isa::scalar: return 1;
        case Isa::sse2:
        case Isa::neon: return 2;
        case Isa::avx2: return 4;
        case Isa::avx512: return 8;
    }
    return 0;
}

bool isa_built(Isa isa) noexcept { return kernel_table(isa) != nullptr; }

bool isa_available(Isa isa) noexcept
{
    if (!isa_built(isa)) return false;
#if defined(FASTCCD_HAVE_X86)
    // The compiler's run-time check also asks whether the operating system saves the registers (XGETBV).
    __builtin_cpu_init();
    if (isa == Isa::avx2) return __builtin_cpu_supports("avx2");
    if (isa == Isa::avx512)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
#endif
    return true;
}

Preferences preferences() noexcept
{
#if defined(FASTCCD_HAVE_X86)
    // AMD's family 25 has AVX-512 from Zen 4 on. There packed scenes take 14 to 36 % less by way of the second-level cache; on
    // family 26 they took 7 % more, and on Zen 3 it made no difference. And there scenes take a fifth longer in single precision, as
    // to convert is half of the work; on family 26 they take 3 to 13 % less from memory, the earliest contact 2 to 21 % (bench/LIMITS.md).
    __builtin_cpu_init();
    if (__builtin_cpu_is("amdfam19h") && __builtin_cpu_supports("avx512f")) return {CacheLevel::second, true};
#endif
    return {};
}

Isa best_isa() noexcept
{
    for (const Isa isa : widest_first)
        if (isa_available(isa)) return isa;
    return Isa::scalar;
}

}  // namespace fastccd
