// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/tables/patchKernels.h"

namespace osd_shading {
inline namespace v1 {

/// The kernels of each file patchKernelsNAME.cpp; those of the x86 sets exist where the build says
/// OSD_SHADING_WITH_NAME. Call them only where the processor has the set: `FindKernels` knows.
extern PatchKernels const kPortableKernels;
extern PatchKernels const kSse2Kernels;
extern PatchKernels const kAvx2Kernels;    // with FMA
extern PatchKernels const kAvx512Kernels;  // F, BW, DQ, VL

}  // namespace v1
}  // namespace osd_shading
