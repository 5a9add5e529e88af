// Mesh files, good and bad, as texts.
#pragma once

#include "tools/scene/mesh_io.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fastccd::tools {

// Appends values in a chosen byte order: the machine's own tells nothing about the other one.
class Bytes {
public:
    explicit Bytes(std::endian order, std::string text = {})
        : order_(order), bytes_(std::move(text))
    {
    }

    template <class T>
    Bytes& add(T value)
    {
        auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
        bytes_.append(raw.begin(), raw.end());
        return *this;
    }

    [[nodiscard]] const std::string& text() const { return bytes_; }

private:
    std::endian order_;
    std::string bytes_;
};

inline Mesh parse_ply(const std::string& content)
{
    return parse_mesh(content, "mesh.ply");
}
inline Mesh parse_obj(const std::string& content)
{
    return parse_mesh(content, "mesh.obj");
}

inline std::string ascii_ply(const std::string& vertices, const std::string& faces,
                      const std::string& type = "double")
{
    const auto lines = [](const std::string& text) {
        return std::to_string(std::count(text.begin(), text.end(), '\n'));
    };
    return "ply\nformat ascii 1.0\nelement vertex " + lines(vertices) + "\nproperty " + type +
           " x\nproperty " + type + " y\nproperty " + type + " z\nelement face " + lines(faces) +
           "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces;
}

inline const std::string triangle_vertices = "0 0 0\n1 0 0\n0 1 0\n";
inline const std::string triangle = ascii_ply(triangle_vertices, "3 0 1 2\n");
inline const std::vector<double> triangle_positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
inline const std::vector<std::int32_t> triangle_faces{0, 1, 2};

}  // namespace fastccd::tools
