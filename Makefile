# libilsa: `make help` lists the targets, `make info` prints the configuration.
#
# Here stands what a newcomer needs. How it is done, and all the rest, stands in mk/: config.mk
# (options, flavours, libraries), build.mk, tests.mk, bench.mk, lint.mk, install.mk.

# ---- Packages -----------------------------------------------------------------------------------
# What `make deps` installs on Debian 12: enough for demo, check, bench, figures, asan, usan.
DEPS = gcc libc6-dev make pkg-config libopenblas-dev liblapacke-dev libfftw3-dev libinih-dev \
       libcmocka-dev gnuplot-nox
# What `make deps-dev` adds: check-long (clang), fuzz (its run-time library), tests/install (g++),
# format, lint and valgrind.
DEPS_DEV = g++ clang libclang-rt-14-dev clang-format clang-tidy cppcheck valgrind

# ---- Jobs ---------------------------------------------------------------------------------------
# As many jobs as cores, unless -j was given.
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(shell nproc 2>/dev/null || echo 2)
endif

# ---- Several goals ------------------------------------------------------------------------------
# Several goals (`make deps check`, `make clean all`) run one after the other, each in a make of its
# own: the packages that the first one installs, or the files that it removes, are seen by the next.
ifneq ($(word 2,$(MAKECMDGOALS)),)

.NOTPARALLEL:
.PHONY: $(MAKECMDGOALS)
$(MAKECMDGOALS):
	@$(MAKE) --no-print-directory $@

else

.DEFAULT_GOAL = all
.DELETE_ON_ERROR:
.SECONDARY:
.SUFFIXES:
MAKEFLAGS += -r

include mk/config.mk mk/build.mk mk/tests.mk mk/bench.mk mk/lint.mk mk/install.mk

# ---- Targets ------------------------------------------------------------------------------------
.PHONY: all lib check demo install uninstall deps deps-dev info clean help

deps: ## installs the Debian packages of DEPS, if any is missing
	@$(call install_missing,$(DEPS))
deps-dev: ## those and the ones of DEPS_DEV
	@$(call install_missing,$(DEPS) $(DEPS_DEV))

all: lib $(PROGRAMS) ## the library into lib/, the example programs into build/bin/
lib: $(LIBRARIES) ## the library alone

check: $(CHECKED:%=check/%) ## the tests; T=name for those whose name contains it
	@sh tests/report.sh $(B)/log $(CHECKED)

DEMO = symmetric_phi1e-2
demo: $(BIN)/ilsa-run ## the paper's three-layer fracture to 3600 s, and its figures, in out/demo
	$(BIN)/ilsa-run examples/scenes/$(DEMO).ini --out out/demo
	examples/figures.sh out/demo

install: lib $(filter %/ilsa-run,$(PROGRAMS)) ## headers, libraries, ilsa.pc, ilsa-run in PREFIX
	$(install_files)

uninstall: ## removes what install put there
	$(uninstall_files)

info: ## prints the configuration
	@printf '%-10s %s\n' version '$(VERSION)' flavour '$(FLAVOUR) ($(B), $(BIN), $(LIB))' \
	    compiler "$$($(CC) --version | head -n 1)" compile '$(COMPILE) $(CFLAGS)' \
	    blas '$(BLAS_PC): $(BLAS_LIBS)' fft '$(FFT): $(or $(FFT_LIBS),the product runs on BLAS)' \
	    ilsa-run '$(if $(INIH_PC),inih,not built: inih not found)' \
	    tests '$(if $(CMOCKA_PC),cmocka,cannot be built: cmocka not found)' \
	    prefix '$(DESTDIR)$(PREFIX)' sources '$(SOURCES)' programs '$(notdir $(PROGRAMS))' \
	    checks '$(TESTS) $(TESTS_LONG)' bench '$(BENCH)'

clean: ## removes build/ and lib/
	rm -rf build lib

help: ## lists the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/\1|\2/p' Makefile mk/*.mk | \
	    awk -F'|' '{ printf "  %-16s%s\n", $$1, $$2 }'

endif
