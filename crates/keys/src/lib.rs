//! `#[derive(Keyed)]` of `hairline-document`: a field of a description is the one entry of its key. From the entry follow the key itself with its documentation,
//! bounds and control, the reader, the checks, the writer and the rows of a panel.
//!
//! | attribute | of | meaning |
//! | --- | --- | --- |
//! | `#[key(unit("m").size())]` | a field | its key, by what follows `Key::new(name, form)`; the field's documentation is the key's meaning |
//! | `#[key("where": ..)]` | a field | the key has another name in the file than the field |
//! | `#[key(RING_RADIUS_M: ..)]` | a field | the constant of the key has another name than the field |
//! | `#[key(= PatternAxis::AXIS)]` | a field | the key of another entry |
//! | `#[flat]` | a field | its own fields are keys of this table |
//! | `#[flat(KEYS)]` | a field | as `#[flat]`, listed by the keys of another list |
//! | `#[read(function)]` | a field | read by `fn(&Table) -> Result<T, Error>` |
//! | `#[by(Type)]` | a field | read, checked and written as another type, which converts from it and into it |
//! | `#[of_kinds]` | a field | a key of those kinds alone that list it |
//! | `#[then(KEY, ..)]` | a field | keys that follow it in lists and are no fields |
//! | `#[keyed(table)]` | a struct | a table of the file: a value by itself |
//! | `#[keyed(table, kinds = Kind)]` | a struct | a table in which a tag tells the kind |
//! | `#[keyed(of_kinds = LISTS)]` | a struct | keys of the table that some kinds alone have: of each kind that has any, its name and the keys |
//! | `#[keyed(own_reader)]` | a struct | as `table`, with a reader of its own |
//! | `#[keyed(default)]` | a struct | its default has the initial values of its keys |
//! | `#[keyed(check = function)]` | a struct, an enum | checked by `fn(&Self, key_path: &str) -> Check` too |
//! | `#[keyed(remote = Type)]` | a struct | stands for a struct of another crate that has the same fields |
//! | `#[keyed(tag = "kind")]` | an enum | the value of the tag tells the variant |
//! | `#[kind("name")]` | a variant | the value of the tag |
//! | `#[keyed(one_of)]` | an enum | a key of several that exclude one another tells the variant |
//!
//! Fields of variants that have no `#[key]` share the key of the field of the same name in another variant.

mod field;
mod kinds;
mod one_of;
mod options;
mod table;

use proc_macro::TokenStream;
use syn::{Data, DeriveInput, Error, Result, parse_macro_input};

use options::Options;

/// See the documentation of the crate.
#[proc_macro_derive(Keyed, attributes(keyed, key, flat, read, by, of_kinds, then, kind))]
pub fn keyed(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    expand(&input)
        .unwrap_or_else(Error::into_compile_error)
        .into()
}

fn expand(input: &DeriveInput) -> Result<proc_macro2::TokenStream> {
    let options = Options::of_type(&input.attrs)?;
    match &input.data {
        Data::Struct(data) => table::expand(input, &options, &data.fields),
        Data::Enum(data) if options.is_one_of => one_of::expand(input, &options, data),
        Data::Enum(data) => kinds::expand(input, &options, data),
        Data::Union(_) => Err(Error::new_spanned(input, "must be a struct or an enum")),
    }
}
