#pragma once

#include <pthread.h>

namespace rotrocc {

/// Names this thread for `top -H` and debuggers: at most 15 letters.
inline void nameThisThread(const char* name) {
  pthread_setname_np(pthread_self(), name);
}

}  // namespace rotrocc
