// One question to the library and everything that can be wrong with the answers.
#pragma once

#include <string>
#include <vector>

#include "../oracle/pair.hpp"

namespace fastccd::testing {

struct Question {
    oracle::Kind kind = oracle::Kind::vertex_face;
    double tolerance = 1e-9;
    double t_max = 1.0;
    double minimum_separation = 0.0;
    double distance_tolerance = 1e-6;
};

/// What is wrong with the answers for one pair, asked alone and in every lane of a batch: missed or late against the
/// oracle, outside [0, t_max], or other bits than the certified search; and with a minimum separation, farther apart at toi
/// than README.md says of any pair. Empty if nothing is.
std::string fault(const Question& question, const oracle::Pair& pair);

/// The same for many pairs at once: the index of the first pair at fault, and what is wrong. Index = size: nothing.
struct BatchFault {
    std::size_t pair;
    std::string what;
    std::size_t undecided = 0;  ///< Pairs before it of which the oracle could not tell whether they come within the separation.
};
BatchFault first_fault(const Question& question, const std::vector<oracle::Pair>& pairs);

/// Changes the question and the pair into simpler ones (fewer bits, zeros, small integers) that are still at fault.
void shrink(Question& question, oracle::Pair& pair);

/// Arguments that ask the same again.
std::string replay_arguments(const Question& question, const oracle::Pair& pair);

/// All answers and the truth, for people.
std::string describe(const Question& question, const oracle::Pair& pair);

}  // namespace fastccd::testing
