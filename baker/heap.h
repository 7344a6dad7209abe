// How the process's heap gives memory back to the system: what comes and goes is large, and the allocator left to
// itself keeps much of it. Large lists have a heap of their own (core/large_blocks.h), which operator new goes to in
// every program that links this. No results depend on it.
#pragma once

namespace ft {

/// Before anything large is allocated.
void set_up_heap();

/// Gives back whole pages that nobody uses, of all threads: some milliseconds now, and again when they are wanted. Of
/// large lists what lately was in use stays for others.
void trim_heap();

/// The same, and nothing stays: what has been in use comes to no more.
void empty_heap();

}  // namespace ft
