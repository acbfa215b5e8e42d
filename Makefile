# libilsa: `make help` lists the targets, `make info` the configuration.

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

# ---- Configuration ------------------------------------------------------------------------------
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

# ---- Files --------------------------------------------------------------------------------------
objects = $(patsubst %.c,$(B)/obj/%.o,$1)
names   = $(patsubst %.c,%,$(notdir $1))

SOURCES  := $(filter-out src/elastic/convolution_fftw.c src/elastic/convolution_none.c,$(wildcard src/*/*.c)) \
            $(wildcard $(FFT_SOURCE))
HEADERS  := $(wildcard include/ilsa/*.h)
EXAMPLES := $(call names,$(wildcard examples/*.c))
RUN      := $(wildcard examples/ilsa_run/*.c)

# tests/test_*.c are programs, tests/long_*.c programs of `make check-long`, the rest is linked into
# all of them; bench/common*.c is linked into all of bench/ and of tests/.
TESTS      := $(call names,$(wildcard tests/test_*.c))
TESTS_LONG := $(call names,$(wildcard tests/long_*.c))
TESTS_WITH := $(filter-out tests/test_% tests/long_%,$(wildcard tests/*.c))
# tests/fuzz/fuzz_*.c are fuzzers, whose corpora are tests too; the one of scenes needs inih.
FUZZERS    := $(filter-out $(if $(INIH_PC),,fuzz_scene),$(call names,$(wildcard tests/fuzz/fuzz_*.c)))
FUZZ_WITH  := tests/fuzz/fuzz.c $(if $(filter fuzz,$(FLAVOUR)),,tests/fuzz/replay.c)
BENCH_WITH := $(wildcard bench/common*.c)
BENCH      := $(call names,$(filter-out $(BENCH_WITH),$(wildcard bench/*.c)))

# `make accuracy` runs bench/accuracy*.c, `make speed` those of BENCH_SPEED, `make extremes` its own,
# nobody bench/long_*.c, tests/same_answer.sh bench/answer.c, `make bench` the others.
BENCH_ACCURACY := $(filter accuracy%,$(BENCH))
BENCH_SPEED    := $(filter speed profile tradeoff features,$(BENCH))
BENCH_QUICK    := $(filter-out accuracy% extremes long_% answer $(BENCH_SPEED),$(BENCH))

PROGRAMS = $(EXAMPLES:%=$(BIN)/%) $(if $(and $(RUN),$(INIH_PC)),$(BIN)/ilsa-run)

# ---- Library ------------------------------------------------------------------------------------
.PHONY: all lib FORCE
all: lib $(PROGRAMS) ## the library into lib/, the example programs into build/bin/
lib: $(LIB_A) ## the library alone
ifeq ($(FLAVOUR),release)
lib: $(LIB_SO) $(LIB_PC)
endif

$(LIB_A): $(call objects,$(SOURCES)) $(B)/flags
	@mkdir -p $(@D)
	$(call say,AR,$@)
	$(Q)rm -f $@ && $(AR) rcs $@ $(filter %.o,$^)

$(LIB_SO): $(call objects,$(SOURCES)) $(B)/flags
	@mkdir -p $(@D)
	$(call say,LD,$@)
	$(Q)$(CC) -shared -Wl,-soname,$(SONAME) -Wl,-z,defs -pthread $(INSTRUMENT) $(CFLAGS) $(LDFLAGS) \
	    -o $@ $(filter %.o,$^) $(LIBS)
	@ln -sf $(@F) $(LIB)/$(SONAME) && ln -sf $(SONAME) $(LIB)/libilsa.so

comma = ,
rpath = -Wl$(comma)-rpath$(comma)$${libdir}

# One template for the tree and for the installed library. In the tree the flags carry the path of
# the shared library, so that what is linked against it runs. What the static library needs stands
# in Libs.private itself: through Requires.private, OpenBLAS would bring in -lgfortran.
pc_file = sed -e 's|@prefix@|$1|' -e 's|@libdir@|$2|' -e 's|@includedir@|$3|' \
    -e 's|@rpath@|$4|' -e 's|@version@|$(VERSION)|' -e 's|@libs@|$(strip $(LIBS)) -pthread|' \
    ilsa.pc.in

$(LIB_PC): ilsa.pc.in include/ilsa/version.h $(B)/flags
	@mkdir -p $(@D)
	@$(call pc_file,$(CURDIR),$${prefix}/lib,$${prefix}/include,$(rpath) ) >$@

# ---- Objects ------------------------------------------------------------------------------------
# Holds every flag; a change of compiler, flags or libraries rebuilds the flavour.
define flags :=
$(shell $(CC) --version 2>/dev/null | head -n 1)
$(COMPILE) $(CFLAGS) $(LDFLAGS)
$(BLAS_CFLAGS) $(FFT_CFLAGS) $(LIBS) $(UNTRACED_$(FLAVOUR))
$(SOURCES)
$(CURDIR)
endef
export flags

$(B)/flags: FORCE
	@$(if $(filter openblas,$(BLAS_PC)),,$(call stop,openblas not found by $(PKG_CONFIG): make deps))
	@$(if $(FFT_MISSING),$(call stop,FFT=$(FFT): $(FFT_MISSING)))
	@mkdir -p $(@D)
	@printf '%s\n' "$$flags" | cmp -s - $@ || printf '%s\n' "$$flags" >$@

$(B)/obj/src/%:      INCLUDE = -Isrc $(BLAS_CFLAGS) $(FFT_CFLAGS) $(UNTRACED_$(FLAVOUR))
$(B)/obj/tests/%:    INCLUDE = -Isrc $(call pc_cflags,$(CMOCKA_PC))
$(B)/obj/tests/fuzz/%: INCLUDE = -Isrc -Iexamples/ilsa_run
$(B)/obj/bench/%:    INCLUDE = -Isrc $(BLAS_CFLAGS)
$(B)/obj/examples/%: INCLUDE = $(call pc_cflags,$(INIH_PC))

$(B)/obj/%.o: %.c $(B)/flags
	@mkdir -p $(@D)
	$(call say,CC,$<)
	$(Q)$(COMPILE) $(INCLUDE) -MMD -MP $(CFLAGS) -c -o $@ $<

-include $(wildcard $(B)/obj/*/*.d $(B)/obj/*/*/*.d)

# ---- Programs -----------------------------------------------------------------------------------
# Linked with the static library: they run from anywhere, and the tests reach what it hides.
define link
@mkdir -p $(@D)
$(call say,LD,$@)
$(Q)$(CC) -pthread $(INSTRUMENT) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(LIB_A) $1 $(LIBS)
endef

$(EXAMPLES:%=$(BIN)/%): $(BIN)/%: $(B)/obj/examples/%.o $(LIB_A)
	$(call link)

$(BIN)/ilsa-run: $(call objects,$(RUN)) $(LIB_A)
	@$(if $(INIH_PC),,$(call stop,inih not found by $(PKG_CONFIG): make deps))
	$(call link,$(call pc_libs,$(INIH_PC)))

BENCH_PROGRAMS = $(BENCH:%=$(BIN)/bench_%)
$(BENCH_PROGRAMS): $(BIN)/bench_%: $(B)/obj/bench/%.o $(call objects,$(BENCH_WITH)) $(LIB_A)
	$(call link)

# What tests/failing.c stands in for.
FAILING = malloc calloc realloc pthread_create fftw_alloc_real fftw_alloc_complex \
          fftw_plan_many_dft fftw_plan_many_dft_r2c fftw_plan_many_dft_c2r

TEST_PROGRAMS = $(TESTS:%=$(BIN)/%) $(TESTS_LONG:%=$(BIN)/%)
$(TEST_PROGRAMS): $(BIN)/%: $(B)/obj/tests/%.o $(call objects,$(TESTS_WITH) $(BENCH_WITH)) $(LIB_A)
	$(call link,$(FAILING:%=-Wl$(comma)--wrap=%) $(call pc_libs,$(CMOCKA_PC)))

# With libFuzzer's main in the flavour fuzz, with one that feeds the corpus in all others.
$(FUZZERS:%=$(BIN)/%): LDFLAGS += $(if $(filter fuzz,$(FLAVOUR)),-fsanitize=fuzzer)
$(FUZZERS:%=$(BIN)/%): $(BIN)/%: $(B)/obj/tests/fuzz/%.o $(call objects,$(FUZZ_WITH)) $(LIB_A)
	$(call link,$(if $(filter %/fuzz_scene,$@),$(call pc_libs,$(INIH_PC))))
$(BIN)/fuzz_scene: $(call objects,$(filter %/scene.c %/draft.c %/keys.c %/ini_file.c,$(RUN)))

# ---- Tests --------------------------------------------------------------------------------------
.PHONY: check check-long asan usan tsan same-answer valgrind coverage fuzz mutants
T           =
CANDIDATES := $(or $(SOME_TESTS),$(TESTS) $(FUZZERS) $(if $(ILSA_LONG),$(TESTS_LONG)))
CHECKED    := $(if $(T),$(foreach t,$(CANDIDATES),$(if $(findstring $(T),$(t)),$(t))),$(CANDIDATES))
FUZZED     := $(filter $(FUZZERS),$(CHECKED))
TEST_TIMEOUT = 3600

# Tests find the programs of their own flavour in $ILSA_BIN.
TEST_ENV = ILSA_BIN=$(BIN) \
    ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1:strict_string_checks=1 \
    UBSAN_OPTIONS=print_stacktrace=1

check: $(CHECKED:%=check/%) ## the tests; T=name for those whose name contains it
	@sh tests/report.sh $(B)/log $(CHECKED)

# Every program writes its log; they run side by side and are reported in order.
.PHONY: $(CHECKED:%=check/%)
$(CHECKED:%=check/%): check/%: $(BIN)/% $(PROGRAMS)
	@mkdir -p $(B)/log
	@start=$$(date +%s); $(TEST_ENV) timeout --foreground $(TEST_TIMEOUT) $(WITHIN) $< >$(B)/log/$*.log 2>&1; \
	echo $$? $$(($$(date +%s) - start)) >$(B)/log/$*.status; \
	echo "ran $<"

check-long: ## every test at full length, then the build, the tests and bench/ with clang
	@$(MAKE) --no-print-directory check ILSA_LONG=1
	@$(MAKE) --no-print-directory FLAVOUR=clang CC=clang all benches check

asan: ## the tests under AddressSanitizer and LeakSanitizer
	@$(MAKE) --no-print-directory FLAVOUR=asan check

usan: ## the tests under UndefinedBehaviorSanitizer, division by zero included
	@$(MAKE) --no-print-directory FLAVOUR=usan check

tsan: ## the tests of threads under ThreadSanitizer
	@$(MAKE) --no-print-directory FLAVOUR=tsan check T=threads

# Builds of other compilers and options, as FLAVOUR:CC:OPT.
ANSWERS = gcc0:gcc:-O0 clang:clang:-O3 clang0:clang:-O0
same-answer: $(BIN)/bench_answer ## one answer from gcc and clang, -O0 and -O3, threads, solvers
	@set -e; for a in $(ANSWERS); do IFS=:; set -- $$a; unset IFS; \
	    $(MAKE) --no-print-directory FLAVOUR=$$1 CC=$$2 OPT=$$3 build/$$1/bin/bench_answer; done
	@sh tests/same_answer.sh $(BIN)/bench_answer \
	    $(foreach a,$(ANSWERS),build/$(firstword $(subst :, ,$a))/bin/bench_answer)

# The programs that take valgrind a minute or two at most; `make asan` runs all of them.
VALGRIND_TESTS = anderson polyline coupled elasticity lubrication march gmres grid handles multigrid tip_cell
VALGRIND = valgrind -q --error-exitcode=9 --leak-check=full \
           --show-leak-kinds=definite,indirect,possible \
           --errors-for-leak-kinds=definite,indirect,possible --suppressions=tests/valgrind.supp

valgrind: ## the shorter tests under valgrind: no error, no leak
	@$(MAKE) --no-print-directory FLAVOUR=valgrind WITHIN='$(VALGRIND)' ILSA_VALGRIND=1 \
	    SOME_TESTS='$(VALGRIND_TESTS:%=test_%)' check

# What a fuzzer finds of its own goes to build/fuzz/corpus, a fault to build/fuzz/fuzz_NAME-*.
FUZZ_SECONDS = 600
FUZZ_ENV     = UBSAN_OPTIONS=print_stacktrace=1
FUZZ_FLAGS   = -timeout=30 -rss_limit_mb=2048 -print_final_stats=1
FUZZ_FLAGS_fuzz_scene    = -max_len=2048
FUZZ_FLAGS_fuzz_snapshot = -max_len=65536
FUZZ_FLAGS_fuzz_api      = -max_len=256
fuzz: ## every fuzzer for FUZZ_SECONDS (600), with clang, ASan and UBSan; T=name as above
	@$(MAKE) --no-print-directory FLAVOUR=fuzz CC=clang run-fuzzers

.PHONY: run-fuzzers
run-fuzzers: $(FUZZED:%=$(BIN)/%)
	@set -e; $(foreach f,$(FUZZED),echo "== $f"; mkdir -p $(B)/corpus/$(f:fuzz_%=%); \
	    $(FUZZ_ENV) $(BIN)/$f -max_total_time=$(FUZZ_SECONDS) $(FUZZ_FLAGS) $(FUZZ_FLAGS_$f) \
	        -artifact_prefix=$(B)/$f- $(B)/corpus/$(f:fuzz_%=%) tests/fuzz/corpus/$(f:fuzz_%=%);)

# What is not reached is of three kinds: answers to what the system has never refused (a mutex, a
# signal mask), ends of iterations that have not failed to converge yet, and bounds that callers
# keep already.
coverage: ## the lines and branches of src/ that the tests reach, and the lines that none reaches
	@rm -f build/coverage/obj/src/*/*.gcda
	@$(MAKE) --no-print-directory FLAVOUR=coverage CC=gcc check
	@for f in $(SOURCES); do $(GCOV) -b -n -o build/coverage/obj/$${f%.c}.o $$f; done 2>/dev/null \
	    | awk -f tests/coverage.awk
	@for f in $(SOURCES); do $(GCOV) -t -o build/coverage/obj/$${f%.c}.o $$f; done 2>/dev/null \
	    | awk -F: '$$2 + 0 == 0 && $$3 == "Source" { file = $$4 } \
	        $$1 ~ /#####/ && file ~ /^src/ { sub(/^[^:]*: */, ""); print file ":" $$0 }'

# The 60 take an hour or so; a run that was interrupted goes on where it stopped.
MUTANT = 1..60
SEED   = 1
mutants: ## how many small faults of src/ the tests find; MUTANT=1..20 for some of the 60
	@sh tests/mutants.sh $(MUTANT) $(SEED)

# ---- Programs that measure and draw -------------------------------------------------------------
.PHONY: benches bench accuracy speed extremes demo figures paper-figures
benches: $(BENCH_PROGRAMS) ## builds all of bench/

bench: $(BENCH_PROGRAMS) ## the quick programs of bench/
	@set -e; for b in $(BENCH_QUICK); do echo "== bench_$$b"; $(BIN)/bench_$$b; done

accuracy: $(BENCH_ACCURACY:%=$(BIN)/bench_%) ## the tables of bench/accuracy*.c
	@set -e; for b in $(BENCH_ACCURACY); do echo "== bench_$$b"; $(BIN)/bench_$$b; done

speed: $(BENCH_SPEED:%=$(BIN)/bench_%) ## the tables of docs/speed.md, in a quarter of an hour
	@set -e; for b in $(BENCH_SPEED); do echo "== bench_$$b"; $(BIN)/bench_$$b; done

extremes: $(BIN)/bench_extremes ## the table of docs/extremes.md, in three minutes
	$<

DEMO = symmetric_phi1e-2
demo: $(BIN)/ilsa-run ## the paper's three-layer fracture to 3600 s, and its figures, in out/demo
	$(BIN)/ilsa-run examples/scenes/$(DEMO).ini --out out/demo
	examples/figures.sh out/demo

figures: ## the figures of every scene that was run into out/
	@set -e; for h in $(wildcard out/*/history.csv); do examples/figures.sh $${h%/history.csv}; done

# Section 5.2: a scene is run again when it or ilsa-run has changed.
PAPER = $(foreach g,symmetric asymmetric drop,$(foreach phi,1e-4 1e-2 1,$(g)_phi$(phi)))
out/paper/%/history.csv: examples/scenes/%.ini $(BIN)/ilsa-run
	$(BIN)/ilsa-run $< --quiet --out $(@D)

paper-figures: $(PAPER:%=out/paper/%/history.csv) ## Figs. 8 to 20 of the paper, in out/paper
	examples/paper_figures.sh out/paper

# ---- Install ------------------------------------------------------------------------------------
.PHONY: install uninstall
INSTALLED = $(HEADERS:include/ilsa/%=$(INCLUDEDIR)/ilsa/%) \
    $(addprefix $(LIBDIR)/,libilsa.a libilsa.so $(SONAME) libilsa.so.$(VERSION)) \
    $(PKGCONFIGDIR)/ilsa.pc $(BINDIR)/ilsa-run

install: lib $(filter %/ilsa-run,$(PROGRAMS)) ## headers, libraries, ilsa.pc, ilsa-run in PREFIX
	install -d "$(DESTDIR)$(INCLUDEDIR)/ilsa" "$(DESTDIR)$(LIBDIR)" "$(DESTDIR)$(PKGCONFIGDIR)"
	install -m 644 $(HEADERS) "$(DESTDIR)$(INCLUDEDIR)/ilsa"
	install -m 644 $(LIB_A) "$(DESTDIR)$(LIBDIR)"
	install -m 755 $(LIB_SO) "$(DESTDIR)$(LIBDIR)"
	ln -sf libilsa.so.$(VERSION) "$(DESTDIR)$(LIBDIR)/$(SONAME)"
	ln -sf $(SONAME) "$(DESTDIR)$(LIBDIR)/libilsa.so"
	$(call pc_file,$(PREFIX),$(LIBDIR:$(PREFIX)%=$${prefix}%),$(INCLUDEDIR:$(PREFIX)%=$${prefix}%),) \
	    >"$(DESTDIR)$(PKGCONFIGDIR)/ilsa.pc"
ifneq ($(filter %/ilsa-run,$(PROGRAMS)),)
	install -d "$(DESTDIR)$(BINDIR)"
	install -m 755 $(BIN)/ilsa-run "$(DESTDIR)$(BINDIR)"
endif
	@if [ -z "$(DESTDIR)" ] && [ "$$(id -u)" = 0 ]; then ldconfig || :; fi

uninstall: ## removes what install put there
	rm -f $(patsubst %,"$(DESTDIR)%",$(INSTALLED))
	@rmdir "$(DESTDIR)$(INCLUDEDIR)/ilsa" 2>/dev/null || :

# ---- Packages -----------------------------------------------------------------------------------
.PHONY: deps deps-dev
deps: ## installs the Debian packages of DEPS, if any is missing
	@$(call install_missing,$(DEPS))
deps-dev: ## those and the ones of DEPS_DEV
	@$(call install_missing,$(DEPS) $(DEPS_DEV))

define install_missing
missing=; \
for p in $1; do \
    dpkg-query -W -f '$${db:Status-Status}\n' $$p 2>/dev/null | grep -qx installed \
        || missing="$$missing $$p"; \
done; \
[ -z "$$missing" ] && exit 0; \
command -v apt-get >/dev/null || { $(call stop,no apt-get here; install the like of$$missing); }; \
echo "installing$$missing"; \
root=; [ "$$(id -u)" = 0 ] || root=sudo; \
$$root env DEBIAN_FRONTEND=noninteractive apt-get update -q && \
$$root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $$missing
endef

# ---- Source care --------------------------------------------------------------------------------
.PHONY: format format-check lint tidy cppcheck analyze
C_FILES  = $(shell find include src tests bench examples -name '*.[ch]' -o -name '*.cpp')
LINTED   = $(SOURCES) $(RUN) $(wildcard examples/*.c bench/*.c tests/*.c tests/fuzz/*.c)

format: ## clang-format over all sources, in place
	clang-format -i $(C_FILES)

format-check: ## fails where clang-format would change something
	clang-format --dry-run -Werror $(C_FILES)

# Each fails on a finding. What is switched off stands with its reason in .clang-tidy (and those of
# bench/ and tests/), in .cppcheck, and below.
lint: tidy cppcheck analyze ## clang-tidy, cppcheck and gcc -fanalyzer over all sources

LINT_CFLAGS = $(STANDARD) -Iinclude -Isrc -Iexamples/ilsa_run $(BLAS_CFLAGS) $(FFT_CFLAGS)

tidy: $(LINTED:%=tidy/%) ## clang-tidy alone
.PHONY: $(LINTED:%=tidy/%)
$(LINTED:%=tidy/%): tidy/%:
	$(call say,TIDY,$*)
	$(Q)clang-tidy --quiet $* -- $(LINT_CFLAGS) 2>/dev/null

cppcheck: ## cppcheck alone
	$(call say,CPPCHECK)
	$(Q)cppcheck --quiet --std=c11 --enable=warning,style,performance,portability --inline-suppr \
	    --suppressions-list=.cppcheck --error-exitcode=1 -Iinclude -Isrc $(LINTED)

# malloc-leak: gcc 12 loses what is stored behind a pointer that a function was handed, which is how
# handles are filled; LeakSanitizer, valgrind and tests/test_memory.c look for leaks instead.
# The others, in tests: assertions of cmocka leave by longjmp, which gcc does not follow, so that a
# pointer may be NULL for it after assert_non_null.
ANALYZE       = -fanalyzer -Werror -Wno-analyzer-malloc-leak
ANALYZE_TESTS = $(addprefix -Wno-analyzer-,possible-null-dereference possible-null-argument \
                null-dereference null-argument use-of-uninitialized-value)

analyze: $(LINTED:%=analyze/%) ## gcc -fanalyzer alone
.PHONY: $(LINTED:%=analyze/%)
$(LINTED:%=analyze/%): analyze/%:
	$(call say,GCC,$*)
	$(Q)gcc $(LINT_CFLAGS) -O2 $(ANALYZE) $(if $(filter tests/%,$*),$(ANALYZE_TESTS)) -c -o /dev/null $*

# ---- The rest -----------------------------------------------------------------------------------
.PHONY: info clean help
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
	@sed -n 's/^\([a-z-]*\):[^#]*## \(.*\)/\1|\2/p' Makefile | \
	    awk -F'|' '{ printf "  %-14s%s\n", $$1, $$2 }'

endif
