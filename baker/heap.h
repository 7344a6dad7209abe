// How the process's heap gives memory back to the system: what comes and goes is large, and the allocator left to
// itself keeps much of it. No results depend on it, and where the C library is not glibc it does nothing.
#pragma once

namespace ft {

/// Before anything large is allocated.
void set_up_heap();

/// Gives back whole pages that nobody uses, of all threads: some milliseconds now, and again when they are wanted.
void trim_heap();

}  // namespace ft
