// SPDX-License-Identifier: Apache-2.0
// Hertz' contact of cylinders and of a sphere, registered with the other cases of contact.
#pragma once

#include "patency/verify/verify_case.h"

namespace patency {

VerifyCase hertz_case();

}   // namespace patency
