#include "core/run_loop.h"

using namespace thimble::firmware;

int main() {
  board::start();
  static RunLoop loop;
  for (;;) loop.pass();
}
