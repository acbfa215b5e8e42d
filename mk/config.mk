# Options, flavours, libraries, places, version.

# ---- Options ------------------------------------------------------------------------------------
# Set on the command line: CC, OPT, CFLAGS, LDFLAGS (added last), WERROR= (warnings stay warnings),
# FFT=fftw|mkl|none, FLAVOUR (see below), PREFIX, LIBDIR, DESTDIR, T (part of a test's name), V=1.

ifeq ($(origin CC),default)
CC = gcc
endif
PKG_CONFIG ?= pkg-config
GCOV ?= gcov

# Each flavour has its own directory under build/; release alone fills lib/ and build/bin/. Any name
# makes another tree: `make CC=clang FLAVOUR=clang` leaves the release build alone.
FLAVOUR = release
B       = build/$(FLAVOUR)
BIN     = $(if $(filter release,$(FLAVOUR)),build,$(B))/bin
LIB     = $(if $(filter release,$(FLAVOUR)),lib,$(B)/lib)

OPT_asan     = -O1 -g
OPT_usan     = -O1 -g
OPT_tsan     = -O2 -g
OPT_valgrind = -O2 -g
OPT_fuzz     = -O2 -g
OPT_coverage = -O0 -g
OPT         ?= $(or $(OPT_$(FLAVOUR)),-O3)

INSTRUMENT_asan     = -fsanitize=address -fno-omit-frame-pointer
INSTRUMENT_usan     = -fsanitize=undefined,float-divide-by-zero -fno-sanitize-recover=all
INSTRUMENT_tsan     = -fsanitize=thread
INSTRUMENT_coverage = --coverage
INSTRUMENT_fuzz     = -fsanitize=fuzzer-no-link,address,undefined,float-divide-by-zero \
                      -fno-sanitize-recover=all -fno-omit-frame-pointer
INSTRUMENT          = $(INSTRUMENT_$(FLAVOUR))
# The fuzzers follow every comparison but those of src/, whose loops would take twice as long.
UNTRACED_fuzz       = -fno-sanitize-coverage=trace-cmp

# Instrumented code makes gcc's flow analysis warn of paths that do not exist.
WERROR ?= $(if $(INSTRUMENT),,-Werror)

# -ffp-contract=off: the same bits whether or not -march allows fused multiply-add, and sums that
# mirror each other stay equal.
STANDARD = -std=c11 -D_POSIX_C_SOURCE=200809L
WARNINGS = -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes $(WERROR)
CODEGEN  = -ffp-contract=off -fvisibility=hidden -fPIC -pthread

# Quiet if the package is not there: the rule of the flags file says what is missing.
pc_exists = $(shell $(PKG_CONFIG) --exists $1 2>/dev/null && echo $1)
pc_cflags = $(if $1,$(patsubst -I%,-isystem %,$(shell $(PKG_CONFIG) --cflags $1 2>/dev/null)))
pc_libs   = $(if $1,$(shell $(PKG_CONFIG) --libs $1 2>/dev/null))

# BLAS and LAPACK: OpenBLAS; LAPACKE from its own package where OpenBLAS comes without, as Debian's.
BLAS_PC     := $(call pc_exists,openblas) $(call pc_exists,lapacke)
BLAS_CFLAGS := $(call pc_cflags,$(BLAS_PC))
BLAS_LIBS   := $(call pc_libs,$(BLAS_PC))

# FFT: FFTW3 (GPL), MKL's FFTW3 interface, or none (the elasticity product runs on BLAS).
ifndef FFT
FFT := $(if $(call pc_exists,fftw3),fftw,none)
endif
ifeq ($(FFT),fftw)
FFT_SOURCE  = src/elastic/convolution_fftw.c
FFT_MISSING := $(if $(call pc_exists,fftw3),,fftw3 not found by $(PKG_CONFIG): make deps)
FFT_CFLAGS := $(call pc_cflags,fftw3)
FFT_LIBS    = -lfftw3_threads $(call pc_libs,fftw3)
else ifeq ($(FFT),mkl)
# The sequential MKL: no threads of its own.
FFT_MISSING = $(if $(MKLROOT)$(filter-out file,$(origin MKL_LIBS)),,set MKLROOT)
MKL_CFLAGS ?= -isystem $(MKLROOT)/include/fftw -isystem $(MKLROOT)/include
MKL_LIBS   ?= -L$(MKLROOT)/lib -Wl,--push-state,--no-as-needed \
              -lmkl_intel_lp64 -lmkl_sequential -lmkl_core -Wl,--pop-state
FFT_SOURCE  = src/elastic/convolution_fftw.c
FFT_CFLAGS  = -DILSA_FFT_MKL $(MKL_CFLAGS)
FFT_LIBS    = $(MKL_LIBS)
else ifeq ($(FFT),none)
FFT_SOURCE  = src/elastic/convolution_none.c
else
$(error FFT=$(FFT): fftw, mkl or none)
endif

# The programs' own needs.
INIH_PC   := $(call pc_exists,inih)
CMOCKA_PC := $(call pc_exists,cmocka)

# V=1 prints the commands.
Q    = $(if $(V),,@)
say  = $(if $(V),,@printf '  %-4s%s\n' $1 $2)

stop = echo "$1" >&2; exit 1

COMPILE = $(CC) $(STANDARD) $(OPT) $(WARNINGS) $(CODEGEN) $(INSTRUMENT) -Iinclude
LIBS    = $(BLAS_LIBS) $(FFT_LIBS) -lm

# OpenBLAS on one thread unless the caller says otherwise: tests run side by side, and its sums
# depend on the number of threads.
export OPENBLAS_NUM_THREADS ?= 1

PREFIX       ?= /usr/local
LIBDIR       ?= $(PREFIX)/lib
INCLUDEDIR   ?= $(PREFIX)/include
BINDIR       ?= $(PREFIX)/bin
PKGCONFIGDIR ?= $(LIBDIR)/pkgconfig
DESTDIR      ?=

# ---- Version ------------------------------------------------------------------------------------
version = $(shell sed -n 's/^\#define ILSA_VERSION_$1 *//p' include/ilsa/version.h)
MAJOR   := $(call version,MAJOR)
VERSION := $(MAJOR).$(call version,MINOR).$(call version,PATCH)

LIB_A  = $(LIB)/libilsa.a
SONAME = libilsa.so.$(MAJOR)
LIB_SO = $(LIB)/libilsa.so.$(VERSION)
LIB_PC = $(LIB)/pkgconfig/ilsa.pc
