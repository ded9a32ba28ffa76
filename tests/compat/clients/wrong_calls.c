/* Makes wrong calls and checks the returned errors: three numbers in one struct, by value. */
#include <HD/hd.h>
#include <stdio.h>

static int is(const char* what, HDerror code, HHD device) {
  const HDErrorInfo error = hdGetError();
  const int right = error.errorCode == code && error.internalErrorCode == 0 && error.hHD == device;
  if (!right) {
    printf("%s: code %#x, internal %d, arm %#x; expected code %#x, arm %#x\n", what,
           error.errorCode, error.internalErrorCode, error.hHD, code, device);
  }
  return right;
}

int main(void) {
  double p[3];
  HHD second;
  int right = is("nothing wrong", HD_SUCCESS, HD_INVALID_HANDLE);
  hdInitDevice(HD_DEFAULT_DEVICE);
  second = hdInitDevice("Phantom2");
  if (second == HD_INVALID_HANDLE) return 2;
  hdMakeCurrentDevice(second); /* not the first: its handle is not 0 */
  hdEndFrame(second);
  right &= is("a frame that was not begun", HD_ILLEGAL_END, second);
  hdBeginFrame(second);
  hdGetDoublev(0xfade, p);
  hdEndFrame(second);
  right &= is("no such parameter", HD_INVALID_ENUM, second);
  right &= is("no more errors", HD_SUCCESS, HD_INVALID_HANDLE);
  hdDisableDevice(second);
  hdDisableDevice(0);
  if (right) printf("errors by value: right\n");
  return right ? 0 : 3;
}
