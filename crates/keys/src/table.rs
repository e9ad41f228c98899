//! Structs: tables of a file, and groups of keys within them.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Fields, Result};

use crate::field::Keyed;
use crate::options::{Options, names};

pub fn expand(input: &DeriveInput, options: &Options, fields: &Fields) -> Result<TokenStream> {
    let owner = &input.ident;
    let target = match &options.remote {
        Some(remote) => quote!(#remote),
        None => quote!(#owner),
    };
    let fields = fields
        .iter()
        .map(|field| Keyed::new(field, &quote!(#owner), false))
        .collect::<Result<Vec<_>>>()?;
    let members: Vec<_> = fields.iter().map(|field| &field.member).collect();
    let constants = fields.iter().filter_map(|field| field.constant.as_ref());
    let entries = fields.iter().map(Keyed::entries);
    let reads = fields.iter().map(Keyed::read);
    let of_self = |field: &Keyed| {
        let member = &field.member;
        quote!(self.#member)
    };
    let checks = fields.iter().map(|field| {
        let value = of_self(field);
        field.check(&quote!(&#value))
    });
    let writes = fields.iter().map(|field| {
        let value = of_self(field);
        field.write(&quote!(&#value))
    });
    let rows = fields.iter().map(|field| {
        let value = of_self(field);
        field.row(&quote!(&mut #value))
    });
    let check_more = options.check_more();
    let default = options.has_default.then(|| {
        let initial = fields.iter().map(Keyed::initial);
        quote! {
            impl Default for #target {
                fn default() -> Self {
                    Self { #(#members: #initial),* }
                }
            }
        }
    });
    let (names, as_value) = (names(), as_value(&target, options));
    // The fields of a struct that stands for another one are entries alone.
    let kinds = options.kinds.as_ref().map(|kinds| {
        let of_table = match &options.of_kinds {
            Some(of_kinds) => quote!(#of_kinds),
            None => quote!(&[]),
        };
        quote! {
            impl #owner {
                /// Its kinds.
                pub(crate) const KINDS: KindKeys = KindKeys {
                    tag: #kinds::TAG,
                    choices: #kinds::CHOICES,
                    of_table: #of_table,
                };
            }
        }
    });
    let stands = options
        .remote
        .is_some()
        .then(|| quote!(const _: fn(&#owner) = |keys| drop((#(&keys.#members),*));));
    Ok(quote! {
        impl #owner {
            #(#constants)*
        }

        const _: () = {
            use #names::*;

            impl Keyed for #target {
                const KEYS: &'static [Entry] = &[#(#entries)*];

                fn read_keys(table: &Table) -> Result<Self, Error> {
                    Ok(Self { #(#members: #reads),* })
                }

                fn check_keys(&self, key_path: &str) -> Check {
                    #(#checks)*
                    #check_more
                }

                fn write_keys<M: serde::ser::SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
                    #(#writes)*
                    Ok(())
                }
            }

            impl Rows for #target {
                fn rows(&mut self, panel: &mut dyn Panel) {
                    #(#rows)*
                }
            }

            #kinds
            #as_value
            #default
            #stands
        };
    })
}

/// What makes a table a value.
fn as_value(target: &TokenStream, options: &Options) -> Option<TokenStream> {
    let open = match &options.kinds {
        Some(_) => quote!(Table::of_kind(Self::KEYS, &Self::KINDS, value, key)?),
        None => quote!(Table::read_entries(Self::KEYS, value, key)?),
    };
    let read = options.is_table.then(|| {
        quote! {
            impl Read for #target {
                fn read(value: &Value, key: &str) -> Result<Self, Error> {
                    Self::read_keys(&#open)
                }
            }
        }
    });
    let initial = match options.has_default {
        true => quote!(Some(Self::default())),
        false => quote!(None),
    };
    (options.is_table || options.has_own_reader).then(|| {
        quote! {
            #read

            impl Numbers for #target {}

            impl KeyValue for #target {
                const FORM: Form = Form::Table;

                fn initial(_: Initial) -> Option<Self> {
                    #initial
                }

                fn check_at(&self, _: &Key, key_path: &str) -> Check {
                    self.check_keys(key_path)
                }

                fn written(&self) -> impl serde::Serialize {
                    self
                }
            }

            impl serde::Serialize for #target {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    serialize(self, serializer)
                }
            }
        }
    })
}
