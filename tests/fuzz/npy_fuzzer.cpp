// Headers of .npy files: what is accepted describes exactly the bytes that are there.
#include <tools/npy.hpp>

#include "fuzz/fuzz_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace fastccd;
    return testing::read_or_refuse(data, size, [&](std::string_view bytes) {
        const tools::NpyHeader header = tools::parse_npy_header(bytes, "fuzz.npy");
        const std::size_t scalar = header.scalar == PairView::Scalar::float64 ? 8 : 4;
        testing::require(header.data_offset <= size &&
                         size - header.data_offset == header.pairs * pair_coordinates * scalar);
    });
}
