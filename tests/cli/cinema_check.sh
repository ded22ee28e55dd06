# cinema_check.sh: the validator of Cinema databases sees each breach, and nothing in good ones.
. "${0%/*}/lib.sh"
last=cinema_check

# good NAME TEXT [--files]: no breach. TEXT as printf's format.
good() {
    mkdir -p "$1.cdb"
    printf "$2" >"$1.cdb/data.csv"
    "$TC_CINEMA" "$1.cdb" ${3:+"$3"} >out 2>err || fail "$1: $(cat out)"
}
# bad NAME TEXT WHERE SAYS [--files]: one line at least begins with WHERE and says SAYS.
bad() {
    mkdir -p "$1.cdb"
    printf "$2" >"$1.cdb/data.csv"
    "$TC_CINEMA" "$1.cdb" ${5:+"$5"} >out 2>err && fail "$1: nothing was seen"
    grep -e "^$3" out | grep -qF -e "$4" || fail "$1: '$4' was not seen at '$3': $(cat out)"
}

good plain 'time,step,tf,FILE\n1.0,2,a,a.png\n'
prints '1 rows, 4 columns'
good crlf 'time,FILE\r\n1.0,a.png\r\n2.5e-03,b.png\r\n'
good quoted 'name,FILE\n"a,b ""c""\nd",x.png\n" blank ",y.png\n'
prints '2 rows'
good unended 'a,b\n1,2'
good missing 'time,tf,FILE\n,,\n1.0,"",a.png\n,b,\n'
good nan 'x,y\n1.0,a\nnan,nan\nNaN,b\n'
good integers 'n,m\n-1,+2\n10,\n'
good paths 'a,FILE\n1,../x.png\n2,https://there.org/y.png\n3,sub/z.png\n'
good only 'one\nword\n'
good utf8 'n\303\244me,\360\237\216\254\na,b\n'

bad float_as_integer 'time,x\n1.0,a\n30,b\n' 'row 3, column 1:' "'30' is an integer, but the column is one of floats"
bad integer_as_float 'time,x\n1,a\n30.5,b\n' 'row 3, column 1:' "'30.5' is a float, but the column is one of integers"
bad late_type 'time,x\n,a\n1,b\nc,d\n' 'row 4, column 1:' 'one of integers since row 3'
bad number_as_text 'tf,x\nwarm,a\n7,b\n' 'row 3, column 1:' 'is an integer, but the column is one of strings'
bad nan_as_integer 'n,x\n1,a\nnan,b\n' 'row 3, column 1:' 'a float'
bad no_point 'time,x\n1e-05,a\n' 'row 2, column 1:' 'no decimal point'
bad few 'a,b,c\n1,2,3\n1,2\n' 'row 3, column 3:' '2 values, the header 3'
bad many 'a,b\n1,2\n1,2,3\n' 'row 3, column 3:' '3 values, the header 2'
bad blank_row 'a,b\n1,2\n\n3,4\n' 'row 3, column 1:' 'the row is empty'
bad blank_before 'a,b\n1, x\n' 'row 2, column 2:' 'a blank'
bad blank_after 'a,b\nx ,y\n' 'row 2, column 1:' 'a blank'
bad blank_in_header 'a, FILE\nx,y\n' 'row 1, column 2:' 'a blank'
bad blank_and_quote 'a,b\nx, "y"\n' 'row 2, column 2:' 'a quote stands within'
bad after_quote 'a,b\n"x"y,z\n' 'row 2, column 1:' 'after a closing quote'
bad inner_quote 'a,b\nx"y,z\n' 'row 2, column 1:' 'a quote stands within'
bad open_quote 'a,b\nx,"y\n' 'row 2, column 2:' 'not closed'
bad lone_return 'a,b\nx\ry,z\n' 'row 2, column 1:' 'carriage return'
bad two_ends 'a,b\r\nx,y\n' 'row 2, column 2:' 'LF and with CRLF'
bad zero_byte 'a,b\nx\000y,z\n' 'row 2, column 1:' 'zero byte'
bad file_first 'FILE,b\nx.png,y\n' 'row 1, column 2:' 'after a FILE column'
bad file_between 'a,FILE,b,FILE2\nx,y.png,z,u.png\n' 'row 1, column 3:' 'after a FILE column'
bad file_number 'a,FILE\nx,12\n' 'row 2, column 2:' 'no path of a file'
bad no_name 'a,,c\nx,y,z\n' 'row 1, column 2:' 'no name'
bad twice 'a,b,a\nx,y,z\n' 'row 1, column 3:' 'that of column 1'
bad number_name 'a,7\nx,y\n' 'row 1, column 2:' 'a number'
bad latin1 'a,b\nx,\344\n' 'line 2:' 'not UTF-8'
bad overlong 'a,b\nx,\300\257\n' 'line 2:' 'not UTF-8'
bad mark '\357\273\277a,b\nx,y\n' '' 'byte-order mark'
bad no_rows 'a,b\n' '' 'no row'
bad nothing '' '' 'no header'

mkdir -p here.cdb/sub && echo x >here.cdb/sub/a.png && : >here.cdb/empty.png && echo x >outside.png
good here 'a,FILE\n1,sub/a.png\n2,../outside.png\n3,\n4,https://there.org/y.png\n' --files
good here "a,FILE\n1,$work/here.cdb/sub/a.png\n" --files
bad here 'a,FILE\n1,sub/b.png\n' 'row 2, column 2:' 'is not there' --files
bad here 'a,FILE\n1,empty.png\n' 'row 2, column 2:' 'is empty' --files
bad here 'a,FILE\n1,sub\n' 'row 2, column 2:' 'is no file' --files
bad here "a,FILE\n1,$work/outside.png\n" 'row 2, column 2:' 'lies outside' --files
good here 'a,FILE\n1,sub/b.png\n'

mkdir -p plain && printf 'a\nb\n' >plain/data.csv
"$TC_CINEMA" plain >out && fail 'a name without .cdb was not seen'
prints 'does not end in .cdb'
mkdir -p without.cdb
"$TC_CINEMA" without.cdb >out && fail 'a database without data.csv was not seen'
prints 'no file that can be read'
"$TC_CINEMA" none.cdb >out && fail 'a database that is not there was not seen'
prints 'is no folder'
: >file.cdb
"$TC_CINEMA" file.cdb >out && fail 'a file was taken for a database'
"$TC_CINEMA" >out 2>err
[ $? -eq 2 ] || fail 'no command line is none that is wrong'
finish
