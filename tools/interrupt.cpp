#include "interrupt.hpp"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <initializer_list>

#include <signal.h>
#include <time.h>

namespace fastccd::tools {
namespace {

// Handlers may run in several threads at once.
std::atomic<int> pending_signal = 0;
std::atomic<std::int64_t> first_signal = 0;  // when it came, in nanoseconds
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free, "a signal handler must not wait");
bool broken_pipes_ignored = false;  // by who started the process

/// A second Ctrl-C ends a process that cannot get to check_interrupt. `timeout` sends a signal to its child and then to the
/// group, so that the same one comes twice at once: only one that comes later than a finger is meant like that.
constexpr std::int64_t nanoseconds_until_second = 300'000'000;

extern "C" void note_signal(int signal)
{
    timespec clock{};
    clock_gettime(CLOCK_MONOTONIC, &clock);
    const std::int64_t now = std::int64_t{1'000'000'000} * clock.tv_sec + clock.tv_nsec;
    std::int64_t first = 0;
    if (first_signal.compare_exchange_strong(first, now)) {
        pending_signal = signal;
        return;
    }
    if (now - first < nanoseconds_until_second) return;
    fastccd::tools::end_by(signal);  // delivered on return from here
}

}  // namespace

void end_by(int signal)
{
    if (signal == SIGPIPE && broken_pipes_ignored) return;
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    sigaction(signal, &action, nullptr);
    raise(signal);
}

void install_signal_handlers()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction previous {};
        // A job started with `nohup` or in the background of a script ignores these on purpose.
        if (sigaction(signal, nullptr, &previous) == 0 && previous.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = note_signal;
        // No SA_RESTART: a write blocked on a full pipe has to wake up.
        sigaction(signal, &action, nullptr);
    }
    broken_pipes_ignored = std::signal(SIGPIPE, SIG_IGN) == SIG_IGN;
    std::signal(SIGXFSZ, SIG_IGN);
}

void check_interrupt()
{
    if (const int signal = pending_signal; signal != 0) throw Interrupted{signal};
}

}  // namespace fastccd::tools
