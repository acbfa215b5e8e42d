# The tests, and other ways to run them; `check` itself stands in the Makefile.

.PHONY: check-long asan usan tsan same-answer valgrind valgrind-quick coverage fuzz mutants
T           =
CANDIDATES := $(or $(SOME_TESTS),$(TESTS) $(FUZZERS) $(if $(ILSA_LONG),$(TESTS_LONG)))
CHECKED    := $(if $(T),$(foreach t,$(CANDIDATES),$(if $(findstring $(T),$(t)),$(t))),$(CANDIDATES))
FUZZED     := $(filter $(FUZZERS),$(CHECKED))
TEST_TIMEOUT = 3600

# Tests find the programs of their own flavour in $ILSA_BIN.
TEST_ENV = ILSA_BIN=$(BIN) \
    ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1:strict_string_checks=1 \
    UBSAN_OPTIONS=print_stacktrace=1

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

# The programs that take valgrind three minutes at most, those of VALGRIND_QUICK a minute or so all
# together; `make asan` runs the whole suite.
VALGRIND_QUICK = anderson gmres grid handles lubrication march multigrid polyline
VALGRIND_TESTS = $(VALGRIND_QUICK) coupled elasticity tip_cell
VALGRIND = valgrind -q --error-exitcode=9 --leak-check=full \
           --show-leak-kinds=definite,indirect,possible \
           --errors-for-leak-kinds=definite,indirect,possible --suppressions=tests/valgrind.supp
VALGRIND_CHECK = $(MAKE) --no-print-directory FLAVOUR=valgrind WITHIN='$(VALGRIND)' \
                 ILSA_VALGRIND=1 check

valgrind: ## the shorter tests under valgrind: no error, no leak
	@$(VALGRIND_CHECK) SOME_TESTS='$(VALGRIND_TESTS:%=test_%)'
valgrind-quick: ## a minute of them
	@$(VALGRIND_CHECK) SOME_TESTS='$(VALGRIND_QUICK:%=test_%)'

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
