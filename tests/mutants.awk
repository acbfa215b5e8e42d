# mutants.awk: draws single-token mutations of C sources and prints them in the order of the draw.
#
#   awk -v seed=1 -v count=60 -f tests/mutants.awk FILE...
#
# A line of output is FILE, LINE, COLUMN, LENGTH, FROM, TO, separated by tabs: LENGTH characters at
# COLUMN, which are FROM, become TO. Every line of code is drawn once at most, then a kind of
# mutation among those that the line offers, then a token of that kind:
#   arithmetic   + and - exchanged, * and / exchanged, their assignments too
#   sign         a minus left out
#   comparison   < turned to >, <= to >=, == to != and back, && to || and back, a ! left out
#   constant     an integer one more, another number twice as large, zero turned to one
#   statement    one that stands on a line of its own left out, unless it declares or returns
# `<` for `<=` is no kind: a bound is hardly ever met exactly. Comments, strings, #include and
# declarations without a value offer nothing. The layout is clang-format's: an operator of two
# operands stands between blanks, the sign and the star of a pointer do not.

BEGIN {
    FS = "\n"
    exchange("arithmetic", "+ - * / += -= *= /=")
    exchange("comparison", "< > <= >= == != && ||")
    random = seed + 0 > 0 ? seed % 2147483646 : 1
    for (k = 0; k < 20; k++)
        below(2)
}

# Park and Miller's generator: every product is exact in double precision, in every awk.
function below(n) {
    random = random * 16807 % 2147483647
    return int(random / 2147483647 * n)
}

FNR == 1 {
    comment = directive = depth = parens = 0
    before = ";"
}

{
    code = without_text($0)
    bare = code
    gsub(/^ +| +$/, "", bare)
    if (bare ~ /^#/ || directive) {
        if (bare ~ /^#define/)
            constants(code, 8 + match(substr(code, 9), /[ (]/))
        directive = bare ~ /\\$/
        next
    }
    opened = parens
    if (bare != "" && !declares_only(bare) && (depth > 0 || bare ~ / = /)) {
        operators(code)
        signs(code)
        constants(code, 1)
    }
    depth += count_of(bare, "{") - count_of(bare, "}")
    parens += count_of(bare, "(") - count_of(bare, ")")
    if (depth > 0 && opened == 0 && parens == 0 && before ~ /([;{}):]|else)$/ && is_statement(bare))
        offer("statement", index(code, bare), length(bare), "(void)0;")
    if (bare != "")
        before = bare
}

# The line with comments and the insides of strings turned to blanks.
function without_text(line, out, k, c, two, quote) {
    out = ""
    quote = ""
    for (k = 1; k <= length(line); k++) {
        c = substr(line, k, 1)
        two = substr(line, k, 2)
        if (comment) {
            out = out " "
            if (two == "*/") {
                out = out " "
                k++
                comment = 0
            }
        } else if (quote != "") {
            out = out " "
            if (c == "\\") {
                out = out " "
                k++
            } else if (c == quote)
                quote = ""
        } else if (two == "/*") {
            out = out "  "
            k++
            comment = 1
        } else if (two == "//") {
            while (length(out) < length(line))
                out = out " "
            return out
        } else if (c == "\"" || c == "'") {
            out = out " "
            quote = c
        } else
            out = out c
    }
    return out
}

function count_of(text, c, n) {
    n = 0
    while (index(text, c) > 0) {
        text = substr(text, index(text, c) + 1)
        n++
    }
    return n
}

# Two names beside each other, which may be a type and what is declared.
function two_names(bare) {
    return bare ~ /^[A-Za-z_][A-Za-z_0-9]* +[*]*[A-Za-z_]/
}

function declares_only(bare) {
    return bare !~ /[=()]/ && two_names(bare) && bare !~ /^(return|else|case|goto) /
}

function is_statement(bare) {
    return bare ~ /;$/ && bare ~ /^[A-Za-z_*(+-]/ && !two_names(bare) &&
           bare !~ /^(return|case|default|do|else|for|if|while|switch|enum|struct|typedef)[^A-Za-z_0-9]/
}

function offer(kind, column, width, to, line) {
    line = FILENAME "\t" FNR
    if (!(line in seen)) {
        seen[line] = 1
        lines[++line_count] = line
    }
    if (!((line, kind) in tokens))
        kinds[line] = kinds[line] " " kind
    tokens[line, kind]++
    what[line, kind, tokens[line, kind]] = column "\t" width "\t" substr($0, column, width) "\t" to
}

# Each operator of a pair becomes the other.
function exchange(kind, list, k, n, at) {
    n = split(list, at, " ")
    for (k = 1; k <= n; k++) {
        other[at[k]] = at[k % 2 ? k + 1 : k - 1]
        kind_of[at[k]] = kind
    }
}

function operators(code, k, end, token) {
    code = code " "
    for (k = 1; k < length(code); k++) {
        if (substr(code, k, 1) != " ")
            continue
        end = k + 1
        while (substr(code, end, 1) != " " && end < length(code))
            end++
        token = substr(code, k + 1, end - k - 1)
        if (token in other)
            offer(kind_of[token], k + 1, length(token), other[token])
    }
}

function signs(code, k, c, last, next_one) {
    for (k = 2; k < length(code); k++) {
        c = substr(code, k, 1)
        last = substr(code, k - 1, 1)
        next_one = substr(code, k + 1, 1)
        if (c == "-" && last ~ /[ (\[{]/ && next_one ~ /[A-Za-z_0-9.(*]/)
            offer("sign", k, 1, "")
        if (c == "!" && next_one != "=")
            offer("comparison", k, 1, "")
    }
}

function constants(code, k, last, number, value, to) {
    while (k <= length(code)) {
        last = k > 1 ? substr(code, k - 1, 1) : " "
        if (last ~ /[A-Za-z_0-9.]/ || !match(substr(code, k), /^[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?/)) {
            k++
            continue
        }
        number = substr(code, k, RLENGTH)
        value = number + 0
        if (substr(code, k + RLENGTH, 1) !~ /[xX]/) {
            if (number ~ /^[0-9]+$/)
                to = sprintf("%d", value + 1)
            else {
                to = sprintf("%.15g", value == 0 ? 1 : 2 * value)
                to = to (to ~ /[.e]/ ? "" : ".0")
            }
            offer("constant", k, length(number), to)
        }
        k += length(number)
    }
}

END {
    for (k = line_count; k > 1; k--) {
        other_one = 1 + below(k)
        line = lines[k]
        lines[k] = lines[other_one]
        lines[other_one] = line
    }
    for (k = 1; k <= line_count && k <= count; k++) {
        n = split(kinds[lines[k]], offered, " ")
        kind = offered[1 + below(n)]
        print lines[k] "\t" what[lines[k], kind, 1 + below(tokens[lines[k], kind])]
    }
}
