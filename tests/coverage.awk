# Turns the output of gcov -b for the files of src/ into a table of lines and branches reached.
function count(text, parts) {
    # "Lines executed:97.50% of 40"
    split(text, parts, /[:%]/)
    total = parts[3]
    sub(/.* of /, "", total)
    return parts[2] / 100 * total
}
function row(name, lines, lines_of, branches, branches_of) {
    printf "%-28s %6.1f %% of %5d lines %6.1f %% of %5d branches\n", name,
        lines_of ? 100 * lines / lines_of : 100, lines_of,
        branches_of ? 100 * branches / branches_of : 100, branches_of
}
/^File/ { open = 0 }
/^File 'src\/[^']*\.c'$/ { file = $2; gsub(/'/, "", file); line_hit = line_all = branch_hit = branch_all = 0; open = 1 }
/^Lines executed/ { line_hit = count($0); line_all = total }
/^Taken at least once/ { branch_hit = count($0); branch_all = total }
/^(Calls executed|No calls)/ && open {
    row(file, line_hit, line_all, branch_hit, branch_all)
    lines += line_hit; lines_all += line_all; branches += branch_hit; branches_all += branch_all
    open = 0
}
END { row("all", lines, lines_all, branches, branches_all) }
