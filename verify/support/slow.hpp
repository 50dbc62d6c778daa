#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

/// Labels a test that takes seconds to repeat code that shorter tests run as well: the first line of its body. Such tests are
/// skipped if the environment variable DRAPE_SKIP_SLOW is set; .ci/run sets it for the tests with sanitizers.
#define DRAPE_SLOW() DRAPE_SLOW_IF(true)

/// The same for some parameters of a test.
#define DRAPE_SLOW_IF(condition)                                                \
  do {                                                                          \
    if ((condition) && std::getenv("DRAPE_SKIP_SLOW") != nullptr) GTEST_SKIP(); \
  } while (false)
