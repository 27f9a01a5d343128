// SPDX-License-Identifier: Apache-2.0

#include "tests/countedAllocations.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::int64_t> numAllocations{0}, numLive{0}, numUntilFailure{0};

void* AllocateOrNull(std::size_t size, std::size_t alignment) noexcept {
    ++numAllocations;
    if (numUntilFailure > 0 && --numUntilFailure == 0) return nullptr;
    // std::aligned_alloc wants whole multiples.
    void* const memory = std::aligned_alloc(alignment, (size + alignment) / alignment * alignment);
    if (memory != nullptr) ++numLive;
    return memory;
}

void Release(void* memory) noexcept {
    if (memory != nullptr) --numLive;
    std::free(memory);
}

void* Allocate(std::size_t size, std::size_t alignment) {
    void* const memory = AllocateOrNull(size, alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return Allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return Allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return Allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, std::nothrow_t const&) noexcept {
    return AllocateOrNull(size, alignof(std::max_align_t));
}
void* operator new[](std::size_t size, std::nothrow_t const&) noexcept {
    return AllocateOrNull(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment, std::nothrow_t const&) noexcept {
    return AllocateOrNull(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment, std::nothrow_t const&) noexcept {
    return AllocateOrNull(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { Release(memory); }
void operator delete[](void* memory) noexcept { Release(memory); }
void operator delete(void* memory, std::size_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::size_t) noexcept { Release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { Release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { Release(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { Release(memory); }
void operator delete(void* memory, std::nothrow_t const&) noexcept { Release(memory); }
void operator delete[](void* memory, std::nothrow_t const&) noexcept { Release(memory); }
void operator delete(void* memory, std::align_val_t, std::nothrow_t const&) noexcept { Release(memory); }
void operator delete[](void* memory, std::align_val_t, std::nothrow_t const&) noexcept { Release(memory); }

namespace osd_shading::tests {

std::int64_t NumAllocations() { return numAllocations; }
std::int64_t NumLiveAllocations() { return numLive; }
void FailAllocation(std::int64_t number) { numUntilFailure = number; }

}  // namespace osd_shading::tests
