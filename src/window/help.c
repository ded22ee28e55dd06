/* help.c: the page of all keys, from one table. */
#include "window/help.h"

#include <string.h>

/* One key, as of gtk_accelerator_parse, several behind blanks; NULL: what the pointer does, in words. */
typedef struct tc_help_row {
    const char *key, *what;
} tc_help_row;

typedef struct tc_help_group {
    const char *title;
    tc_help_row row[20];
} tc_help_group;

static const tc_help_group tc_group[] = {
    {"Window",
     {{"<Control>o", "Open data, a scene, a picture or a preset"},
      {"<Control>s", "Save the function as a preset"},
      {"<Control><Shift>s", "Save the scene"},
      {"<Control>e", "Save the picture"},
      {"<Control><Shift>c", "Copy as command line"},
      {"<Control>z", "Undo"},
      {"<Control><Shift>z <Control>y", "Redo"},
      {"F10", "Menu"},
      {"F6 <Shift>F6", "Next, previous part of the window"},
      {"<Control>w <Control>q", "Close the window"}}},
    {"Picture",
     {{"Left Right Up Down", "Turn (left drag)"},
      {"<Shift>Left <Shift>Right", "Shift (middle or Shift drag)"},
      {"<Control>Left <Control>Right", "Roll (Ctrl drag)"},
      {"plus minus", "Draw near, away (wheel, right drag)"},
      {"x y z", "Look from the positive side of an axis"},
      {"<Shift>x <Shift>y <Shift>z", "From the negative side"},
      {"r", "Camera as at the start"},
      {"p", "Probe: the values along the ray under the pointer"}}},
    {"Opacity curve",
     {{"Tab <Shift>Tab", "Next, previous point"},
      {"Home End", "First, last point"},
      {"space", "Select the point or not (Shift click)"},
      {"<Control>a", "Select all"},
      {"Left Right Up Down", "Move what is selected (drag)"},
      {"<Shift>Left <Shift>Up", "Move far"},
      {"Insert", "Add a point (click on the curve)"},
      {"Delete", "Delete what is selected"},
      {"Return", "Type scalar and opacity"},
      {"Escape", "Leave the tool, give up a drag"}}},
    {"Colours",
     {{"Tab <Shift>Tab", "Next, previous colour point"},
      {"Left Right", "Move what is selected (drag)"},
      {"Insert", "Add a colour (double click)"},
      {"Delete", "Delete what is selected"},
      {"Return", "Choose the colour"}}},
    {"Colour maps", {{"Return", "Take the map (double click)"}, {"Down", "From the search into the list"}}},
};

static void tc_help_append(GString *xml, const tc_help_row *row)
{
    char *text = g_markup_printf_escaped("<child><object class='GtkShortcutsShortcut'>"
                                         "<property name='accelerator'>%s</property>"
                                         "<property name='title'>%s</property></object></child>",
                                         row->key, row->what);
    g_string_append(xml, text);
    g_free(text);
}

void tc_help_attach(GtkApplicationWindow *window)
{
    GString *xml = g_string_new("<interface><object class='GtkShortcutsWindow' id='help'>"
                                "<property name='modal'>1</property><child>"
                                "<object class='GtkShortcutsSection'><property name='section-name'>keys</property>"
                                "<property name='max-height'>14</property>");
    for (size_t g = 0; g < G_N_ELEMENTS(tc_group); g++) {
        char *title = g_markup_printf_escaped("<child><object class='GtkShortcutsGroup'>"
                                              "<property name='title'>%s</property>",
                                              tc_group[g].title);
        g_string_append(xml, title);
        g_free(title);
        for (const tc_help_row *row = tc_group[g].row; row->what; row++)
            tc_help_append(xml, row);
        g_string_append(xml, "</object></child>");
    }
    g_string_append(xml, "</object></child></object></interface>");
    GtkBuilder *builder = gtk_builder_new_from_string(xml->str, (gssize)xml->len);
    gtk_application_window_set_help_overlay(window, GTK_SHORTCUTS_WINDOW(gtk_builder_get_object(builder, "help")));
    g_object_unref(builder);
    g_string_free(xml, TRUE);
}
