// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "osd_shading/export.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Reads a control mesh from a Wavefront OBJ file, with all the ways in which sharpness is written in one.
///
///     v vt vn f    as usual: n-gons, negative indices, vertices defined after the faces that use them;
///                  further numbers of `v` (weight, colour), `vt` and `vn` are ignored
///     l            each edge of the polyline is infinitely sharp; it must be an edge of a face
///     p            each vertex is infinitely sharp
///     t            OpenSubdiv's tags, indices from 0: `t NAME ints/floats/strings VALUES..` with crease, corner,
///                  hole, interpolateboundary, facevaryinginterpolateboundary, creasemethod, smoothtriangles;
///                  hierarchical edits and other tags are ignored with a warning each
///     fs, as       [ZBK23]'s sharpness lines, see FaceSharpness
///     OFF 0        from here on indices of `f`, `l` and `p` count from 0; OFF 1: from 1 again
///
/// `#` begins a comment anywhere. Groups, names, materials, smoothing groups and free-form geometry are skipped;
/// a line with any other first word is skipped with one warning, which names the first such line.
///
/// Kept as written are faces in their order, isolated vertices, and several entries for one crease.
///
/// ERRORS: ReadError; ParseError, with the line: not a number, fewer than three coordinates or one that isn't
/// finite, an index that nothing has, a face of fewer than three vertices or with a repeated one, a crease that
/// isn't an edge, negative or NaN sharpness, a malformed tag; without a line: no face at all.
/// COST: one pass; 500,000 faces take some tenths of a second.
OSD_SHADING_API Model ReadObj(std::string const& path);

/// The same from a text that is already in memory; `fileName` is what errors, warnings and `name` come from.
OSD_SHADING_API Model ParseObj(std::string_view text, std::string const& fileName);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
