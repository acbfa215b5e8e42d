#include "elastic/convolution.h"

const convolution_method *const ilsai_convolution_fft = NULL;
