// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "methodOptions.h"
#include "osd_shading/io/model.h"
#include "osd_shading/shadingInput.h"

namespace osd_shading::tool {

// From a file and the options of the method to what the library takes; errors name file and line.

/// Reads `file` and applies what `options` say of it. Incomplete UVs are left out, with a warning.
io::Model ReadModel(std::string const& file, MeshOptions const& options);

/// What `options` change in a model that is read: sharpness file, crease angle, crease scale.
void ApplyMeshOptions(MeshOptions const& options, io::Model& model);

/// Leaves UVs out, with a warning, where not every face corner has one.
void LeaveOutPartialUvs(std::string const& file, io::Model& model);

/// Throws ParseError, with the line, for a face that `scheme` can't take. The library would refuse it too, but
/// knows no lines.
void RequireTriangles(std::string const& file, Sdc::SchemeType scheme, io::Model const& model);

/// A model's numbers in the precision of the run; `input` views them.
template <typename Real>
struct RunInput {
    std::vector<Real> positions, uvs, cornerNormals;
    ShadingInput<Real> input;
};

/// ERRORS: ParseError where `startNormals` are the file's and one is missing, or where a number is too large.
template <typename Real>
RunInput<Real> MakeInput(std::string const& file, io::Model const& model, StartNormalKind startNormals);

extern template RunInput<float> MakeInput(std::string const&, io::Model const&, StartNormalKind);
extern template RunInput<double> MakeInput(std::string const&, io::Model const&, StartNormalKind);

}  // namespace osd_shading::tool
