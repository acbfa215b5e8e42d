# Files, library, objects, programs.

# ---- Files --------------------------------------------------------------------------------------
objects = $(patsubst %.c,$(B)/obj/%.o,$1)
names   = $(patsubst %.c,%,$(notdir $1))

SOURCES  := $(filter-out src/elastic/convolution_fftw.c src/elastic/convolution_none.c,$(wildcard src/*/*.c)) \
            $(wildcard $(FFT_SOURCE))
HEADERS  := $(wildcard include/ilsa/*.h include/ilsa/*.def)
EXAMPLES := $(call names,$(wildcard examples/*.c))
RUN      := $(wildcard examples/ilsa_run/*.c)

# What reads scene files is linked with the parts of ilsa-run, and is left out where there is no inih.
READ_SCENES := field test_field_scenes fuzz_scene
NEED_INIH   := $(if $(INIH_PC),,$(READ_SCENES))
SCENES_WITH := $(filter-out %/main.c,$(RUN)) $(wildcard bench/scene_files/*.c)

# tests/test_*.c are programs, tests/long_*.c programs of `make check-long`, the rest is linked into
# all of them; bench/common*.c is linked into all of bench/ and of tests/.
TESTS      := $(filter-out $(NEED_INIH),$(call names,$(wildcard tests/test_*.c)))
TESTS_LONG := $(call names,$(wildcard tests/long_*.c))
TESTS_WITH := $(filter-out tests/test_% tests/long_%,$(wildcard tests/*.c))
# tests/fuzz/fuzz_*.c are fuzzers, whose corpora are tests too.
FUZZERS    := $(filter-out $(NEED_INIH),$(call names,$(wildcard tests/fuzz/fuzz_*.c)))
FUZZ_WITH  := tests/fuzz/fuzz.c $(if $(filter fuzz,$(FLAVOUR)),,tests/fuzz/replay.c)
BENCH_WITH := $(wildcard bench/common*.c)
BENCH      := $(filter-out $(NEED_INIH),$(call names,$(filter-out $(BENCH_WITH),$(wildcard bench/*.c))))

# `make accuracy` runs bench/accuracy*.c, `make speed` those of BENCH_SPEED, `make extremes` its own,
# `make field` its own,
# nobody bench/long_*.c, tests/same_answer.sh bench/answer.c, `make bench` the others.
BENCH_ACCURACY := $(filter accuracy%,$(BENCH))
BENCH_SPEED    := $(filter speed profile tradeoff features,$(BENCH))
BENCH_QUICK    := $(filter-out accuracy% extremes field long_% answer $(BENCH_SPEED),$(BENCH))

PROGRAMS = $(EXAMPLES:%=$(BIN)/%) $(if $(and $(RUN),$(INIH_PC)),$(BIN)/ilsa-run)

# ---- Library ------------------------------------------------------------------------------------
.PHONY: FORCE

# The release alone has a shared library and a pkg-config file.
LIBRARIES = $(LIB_A) $(if $(filter release,$(FLAVOUR)),$(LIB_SO) $(LIB_PC))

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
	$(call link,$(scene_libs))

# What tests/failing.c stands in for.
FAILING = malloc calloc realloc pthread_create fftw_alloc_real fftw_alloc_complex \
          fftw_plan_many_dft fftw_plan_many_dft_r2c fftw_plan_many_dft_c2r

TEST_PROGRAMS = $(TESTS:%=$(BIN)/%) $(TESTS_LONG:%=$(BIN)/%)
$(TEST_PROGRAMS): $(BIN)/%: $(B)/obj/tests/%.o $(call objects,$(TESTS_WITH) $(BENCH_WITH)) $(LIB_A)
	$(call link,$(FAILING:%=-Wl$(comma)--wrap=%) $(call pc_libs,$(CMOCKA_PC)) $(scene_libs))

# With libFuzzer's main in the flavour fuzz, with one that feeds the corpus in all others.
$(FUZZERS:%=$(BIN)/%): LDFLAGS += $(if $(filter fuzz,$(FLAVOUR)),-fsanitize=fuzzer)
$(FUZZERS:%=$(BIN)/%): $(BIN)/%: $(B)/obj/tests/fuzz/%.o $(call objects,$(FUZZ_WITH)) $(LIB_A)
	$(call link,$(scene_libs))

scene_libs = $(if $(filter $(READ_SCENES),$(patsubst bench_%,%,$(@F))),$(call pc_libs,$(INIH_PC)))
$(READ_SCENES:%=$(BIN)/%) $(BIN)/bench_field: $(call objects,$(SCENES_WITH))
