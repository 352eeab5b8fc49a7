// Threads that are kept for the next call. TBB's allocator keeps some kilobytes for every thread that it has ever met, so
// that a new one for each render would be a leak.
#pragma once

#include <functional>

namespace whit::python {

/// Runs a job, which throws nothing, in a thread of its own: one that is idle, or a new one. They live as long as the
/// process.
void run_in_thread(std::function<void()> job);

}  // namespace whit::python
