//! Structs: tables of a file, and groups of keys within them.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Fields, Result};

use crate::field::Keyed;
use crate::options::Options;

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
    let as_value = as_value(&target, options);
    // The fields of a struct that stands for another one are entries alone.
    let stands = options
        .remote
        .is_some()
        .then(|| quote!(const _: fn(&#owner) = |keys| drop((#(&keys.#members),*));));
    Ok(quote! {
        impl #owner {
            #(#constants)*
        }

        const _: () = {
            use crate::description::keyed::Keyed;
            use crate::description::panel::{Panel, Rows};
            use crate::description::ranges::Check;
            use crate::description::table::{KeyValue, Read, Table, Value};
            use crate::error::Error;

            impl Keyed for #target {
                const KEYS: &'static [crate::schema::Entry] = &[#(#entries)*];

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

            #as_value
            #default
            #stands
        };
    })
}

/// What makes a table a value.
fn as_value(target: &TokenStream, options: &Options) -> Option<TokenStream> {
    let open = match &options.kinds {
        Some(kinds) => quote!(Table::of_kind::<#kinds>(Self::KEYS, value, key)?),
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

            impl crate::description::ranges::Numbers for #target {}

            impl KeyValue for #target {
                const FORM: crate::schema::Form = crate::schema::Form::Table;

                fn initial(_: crate::schema::Initial) -> Option<Self> {
                    #initial
                }

                fn check_at(&self, _: &crate::schema::Key, key_path: &str) -> Check {
                    self.check_keys(key_path)
                }

                fn written(&self) -> impl serde::Serialize {
                    self
                }
            }

            impl serde::Serialize for #target {
                fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    crate::description::keyed::serialize(self, serializer)
                }
            }
        }
    })
}
