#include "tests/lobe/gl_test_main.h"

#include <gtest/gtest.h>

#include <iostream>
#include <memory>

#include "assets/error.h"

namespace {
std::unique_ptr<chiaro::gl::HeadlessContext> theContext;
}

chiaro::gl::HeadlessContext& testContext() { return *theContext; }

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  try {
    theContext = std::make_unique<chiaro::gl::HeadlessContext>();
  } catch (const chiaro::Error& error) {
    std::cout << "skipped: " << error.what() << "\n";
    return 77;
  }
  std::cout << "GL_RENDERER " << theContext->renderer() << "\nGL_VERSION  " << theContext->version() << "\nEGL platform " << theContext->platform() << "\n";
  const int result = RUN_ALL_TESTS();
  theContext.reset();
  return result;
}
