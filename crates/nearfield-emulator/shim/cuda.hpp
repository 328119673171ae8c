// CUDA C++ as a compiler for the host understands it. Included before each kernel source, which is then compiled inside
// an unnamed namespace: sources are separate modules on a GPU, so equal names in two of them must not meet.

#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <math.h>
#include <stdlib.h>

#include "vectors.hpp"

#include "machine.hpp"

#include "atomics.hpp"
#include "kernel.hpp"
#include "numbers.hpp"
#include "raytracing.hpp"
#include "warp.hpp"
