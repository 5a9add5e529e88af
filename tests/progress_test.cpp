// How many pairs the command answers at a time, and what its progress bar shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "tools/narrow_phase_run.hpp"
#include "tools/progress.hpp"

namespace fastccd::testing {
namespace {

TEST(PieceSize, FollowsTheTime)
{
    using tools::PieceSize;
    PieceSize size{1};
    EXPECT_EQ(size.pairs(), PieceSize::undivided);
    for (int i = 0; i < 20; ++i) size.took(size.pairs(), 1.0);
    EXPECT_EQ(size.pairs(), PieceSize::least);
    size.took(size.pairs(), 0.05);
    EXPECT_EQ(size.pairs(), PieceSize::least);
    for (int i = 0; i < 20; ++i) size.took(size.pairs(), 1e-9);
    EXPECT_EQ(size.pairs(), PieceSize::most);
    size.took(PieceSize::least, 1e-9);  // the rest of a buffer says little
    EXPECT_EQ(size.pairs(), PieceSize::most);
    size.took(PieceSize::most, 0.05);
    EXPECT_EQ(size.pairs(), PieceSize::most);
    size.took(PieceSize::most, 0.2);
    EXPECT_EQ(size.pairs(), PieceSize::most / 4);
    EXPECT_EQ(size.pairs() % 8, 0u);

    // Where a pair takes a millisecond, as many as keep all threads busy.
    PieceSize of_four{4};
    for (int i = 0; i < 20; ++i) of_four.took(of_four.pairs(), 1e-3 * 64);
    EXPECT_EQ(of_four.pairs(), 4 * PieceSize::undivided);
}

TEST(ProgressLine, FitsEveryTerminal)
{
    using tools::progress_line;
    for (std::size_t width = 0; width < 200; ++width) {
        for (const std::size_t done : {0U, 1U, 500U, 1000U}) {
            const std::string line = progress_line(done, 1000, 2.0, width);
            EXPECT_LT(line.size(), std::max<std::size_t>(width, 1));
            EXPECT_EQ(line.empty(), width <= 5) << width;
        }
    }
    EXPECT_EQ(progress_line(500'000'000, 2'000'000'000, 10, 70),
              "[#######                        ]  25 %  50.0 M pairs/s  0:00:30 left");
    EXPECT_EQ(progress_line(0, 0, 0, 10), "100 %");
}

}  // namespace
}  // namespace fastccd::testing
