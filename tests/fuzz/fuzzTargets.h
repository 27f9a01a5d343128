// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// What the fuzzers call: each takes any bytes, and ends the process where the library breaks a promise.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace fuzz {

/// The bytes as an OBJ file: read, or refused with a ParseError; small models are shaded.
void FuzzObj(std::uint8_t const* data, std::size_t size);

/// The bytes as a `.sharp` file for a small model.
void FuzzSharp(std::uint8_t const* data, std::size_t size);

/// The bytes as a small mesh with options: shaded at once, in double and in float, and by a table and a frame of
/// it.
void FuzzMesh(std::uint8_t const* data, std::size_t size);

/// Ends the process, so that libFuzzer keeps the input, unless `isKept`.
inline void Require(bool isKept, char const* promise) {
    if (isKept) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

}  // namespace fuzz
