// SPDX-License-Identifier: Apache-2.0
#include <opensubdiv/sdc/types.h>

#include <cstdio>

int main() {
    // Not inline: the library must be linked.
    std::puts(OpenSubdiv::Sdc::SchemeTypeTraits::GetName(OpenSubdiv::Sdc::SCHEME_CATMARK));
}
