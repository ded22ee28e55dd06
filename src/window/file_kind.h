/* file_kind.h: what a file that is opened or dropped is to the window. No GTK here. */
#ifndef TC_WINDOW_FILE_KIND_H
#define TC_WINDOW_FILE_KIND_H

typedef enum tc_file_kind {
    TC_FILE_DATA = 0,
    TC_FILE_SCENE,   /* a scene, or a ParaView state or camera file */
    TC_FILE_PICTURE, /* by its metadata a scene */
    TC_FILE_PRESET   /* colour maps */
} tc_file_kind;

/* By extension and, of .json and .xml, by what is in it: what holds a colour map is a preset. Of a file that cannot be
 * read by extension alone. Cost: reads a .json or .xml file. */
tc_file_kind tc_file_kind_of(const char *path);

#endif
